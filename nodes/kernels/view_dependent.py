"""Colours of surface points from several pictures, weighted by where they are looked at from."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numba import njit

from reperform.nodes.kernels.camera import radial_limit
from reperform.nodes.kernels.source_view import SourceView

# Radians: a source camera this near the virtual one is as good as the same camera.
SAME_DIRECTION = 0.03


def view_dependent_colour(
    points: np.ndarray,
    normals: np.ndarray,
    towards: np.ndarray | None,
    views: Sequence[SourceView],
    *,
    sharpness: float = 4.0,
    bias: float = 0.003,
    gains: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Blend what the views show at points (P, 3) with normals (P, 3), seen along `towards` (P, 3).

    towards: unit directions from the points to the virtual eye, in the space of the capture; None: blend for
    no eye in particular. Per point and camera c: visible_c falls from 1 to 0 as the point lies bias .. 2
    bias (m) behind the depth map; facing_c = max(0, n . d_c) with d_c the direction to the camera; angle_c =
    angle between `towards` and d_c; trust_c from the view, bilinear;
    weight_c = visible_c trust_c facing_c / (angle_c + 0.03)^sharpness (None: facing_c squared, no angle);
    colour = sum_c weight_c gain_c colour_c / sum_c weight_c.
    Returns colour (P, 3) float32 0..255 and reliability (P,) float32: the largest visible_c trust_c facing_c;
    where it is 0 nothing is known and the colour is 0.

    Source: Debevec, Yu and Borshukov 1998, EGRW (weights by angle); Buehler et al. 2001, SIGGRAPH (continuity
    in angle, visibility and picture borders). Departure: a power of the angle over all cameras in place of
    the k nearest, so that no camera enters or leaves with a jump.
    """
    count = len(points)
    total = np.zeros(count)
    colour = np.zeros((count, 3))
    reliability = np.zeros(count)
    aimed = towards is not None
    directions = np.zeros((count, 3)) if towards is None else np.ascontiguousarray(towards, np.float64)
    for index, view in enumerate(views):
        _accumulate(
            np.ascontiguousarray(points, np.float64),
            np.ascontiguousarray(normals, np.float64),
            directions,
            aimed,
            view.image,
            view.depth,
            view.trust,
            view.origin,
            view.matrix,
            view.rotation,
            view.translation,
            view.distortion,
            radial_limit(view.distortion) ** 2,
            np.ones(3) if gains is None else np.ascontiguousarray(gains[index], np.float64),
            sharpness,
            bias,
            total,
            colour,
            reliability,
        )
    colour /= np.maximum(total, 1e-30)[:, None]
    return np.minimum(colour, 255.0).astype(np.float32), reliability.astype(np.float32)


@njit(cache=True, nogil=True)
def _accumulate(
    points: np.ndarray,
    normals: np.ndarray,
    towards: np.ndarray,
    aimed: bool,
    image: np.ndarray,
    depth: np.ndarray,
    trust: np.ndarray,
    origin: np.ndarray,
    matrix: np.ndarray,
    rotation: np.ndarray,
    translation: np.ndarray,
    distortion: np.ndarray,
    limit: float,
    gain: np.ndarray,
    sharpness: float,
    bias: float,
    total: np.ndarray,
    colour: np.ndarray,
    reliability: np.ndarray,
) -> None:
    height, width = depth.shape
    k1, k2, p1, p2, k3 = distortion[0], distortion[1], distortion[2], distortion[3], distortion[4]
    eye = -(rotation.T @ translation)
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        dx, dy, dz = eye[0] - x, eye[1] - y, eye[2] - z
        length = np.sqrt(dx * dx + dy * dy + dz * dz) + 1e-30
        facing = (normals[i, 0] * dx + normals[i, 1] * dy + normals[i, 2] * dz) / length
        if facing <= 0:
            continue
        far = rotation[2, 0] * x + rotation[2, 1] * y + rotation[2, 2] * z + translation[2]
        if far <= 0:
            continue
        u = (rotation[0, 0] * x + rotation[0, 1] * y + rotation[0, 2] * z + translation[0]) / far
        v = (rotation[1, 0] * x + rotation[1, 1] * y + rotation[1, 2] * z + translation[1]) / far
        r = u * u + v * v
        if r >= limit:
            continue
        radial = 1 + r * (k1 + r * (k2 + r * k3))
        lens_u = u * radial + 2 * p1 * u * v + p2 * (r + 2 * u * u)
        lens_v = v * radial + p1 * (r + 2 * v * v) + 2 * p2 * u * v
        px = matrix[0, 0] * lens_u + matrix[0, 1] * lens_v + matrix[0, 2] - origin[0]
        py = matrix[1, 1] * lens_v + matrix[1, 2] - origin[1]
        if not (px >= 0 and py >= 0 and px < width - 1 and py < height - 1):
            continue
        column, row = int(px), int(py)
        fx, fy = px - column, py - row
        # Between the four depths, so that a point on a slope is not behind itself.
        share, seen = 0.0, 0.0
        for dr in range(2):
            for dc in range(2):
                if depth[row + dr, column + dc] < np.inf:
                    part = (fy if dr else 1 - fy) * (fx if dc else 1 - fx)
                    share += part
                    seen += part * depth[row + dr, column + dc]
        if not share > 0:
            continue
        behind = seen / share
        visible = min(1.0, 2.0 - (far - behind) / bias)
        if not visible > 0:
            continue
        a, b, c, e = (1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy
        safe = (
            a * trust[row, column]
            + b * trust[row, column + 1]
            + c * trust[row + 1, column]
            + e * trust[row + 1, column + 1]
        )
        quality = visible * safe * facing
        if not quality > 0:
            continue
        if aimed:
            cosine = (towards[i, 0] * dx + towards[i, 1] * dy + towards[i, 2] * dz) / length
            angle = np.arccos(min(1.0, max(-1.0, cosine)))
            weight = quality * (angle + SAME_DIRECTION) ** -sharpness
        else:
            weight = quality * facing
        total[i] += weight
        reliability[i] = max(reliability[i], quality)
        for k in range(3):
            colour[i, k] += (
                weight
                * gain[k]
                * (
                    a * image[row, column, k]
                    + b * image[row, column + 1, k]
                    + c * image[row + 1, column, k]
                    + e * image[row + 1, column + 1, k]
                )
            )
