"""Rigid motions of the ground plane: a turn about the vertical and a shift along it.

A placement (yaw, offset) takes x to R_y(yaw) x + (offset_x, 0, offset_z), with
R_y(yaw) = [[cos, 0, sin], [0, 1, 0], [-sin, 0, cos]].
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class Placement(NamedTuple):
    """A turn about the vertical (radians) and a shift (x, z) in metres."""

    yaw: float
    offset: np.ndarray


IDENTITY = Placement(0.0, np.zeros(2))


def align(
    points: np.ndarray, moved: np.ndarray, weights: np.ndarray | None = None
) -> tuple[Placement, float]:
    """The placement T that minimises sum_i w_i |points_i - T moved_i|^2, and that minimum.

    points, moved: (N, 3) corresponding points, m; weights: (N,), not negative (default: all 1). Closed form:
    with weighted means taken off, yaw = atan2(sum w (x z' - x' z), sum w (x x' + z z')); the offset joins the
    means.
    The turn is 0 where the points do not tell one (all on a vertical line).
    Raises ValueError where shapes differ or no weight is positive.

    Source: Kovar, Gleicher and Pighin 2002, SIGGRAPH, section 3.1 (003 eq 5).
    """
    if points.shape != moved.shape or points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(
            f"align: two (N, 3) point sets of one length needed, got {points.shape}, {moved.shape}"
        )
    p, q = points.astype(np.float64), moved.astype(np.float64)
    w = np.ones(len(p)) if weights is None else np.asarray(weights, np.float64)
    total = float(w.sum())
    if not total > 0.0:
        raise ValueError(f"align: the weights must have a positive sum, got {total}")
    centre_p, centre_q = w @ p / total, w @ q / total
    x, z = p[:, 0] - centre_p[0], p[:, 2] - centre_p[2]
    x2, z2 = q[:, 0] - centre_q[0], q[:, 2] - centre_q[2]
    sine = w @ (x * z2 - x2 * z)
    cosine = w @ (x * x2 + z * z2)
    yaw = float(np.arctan2(sine, cosine)) if np.hypot(sine, cosine) > 1e-12 * total else 0.0
    shift = centre_p[[0, 2]] - rotate_ground(centre_q[[0, 2]], yaw)
    placement = Placement(yaw, shift)
    gap = p - apply(q, placement)
    return placement, float(w @ np.einsum("nk,nk->n", gap, gap))


def rotate_ground(vectors: np.ndarray, yaw: float | np.ndarray) -> np.ndarray:
    """Turn ground vectors (..., 2), columns x and z, about the vertical."""
    c, s = np.cos(yaw), np.sin(yaw)
    x, z = vectors[..., 0], vectors[..., 1]
    return np.stack([c * x + s * z, -s * x + c * z], axis=-1)


def apply(points: np.ndarray, placement: Placement) -> np.ndarray:
    """Place points (..., 3); the dtype is kept."""
    ground = rotate_ground(points[..., [0, 2]].astype(np.float64), placement.yaw) + placement.offset
    placed = np.stack([ground[..., 0], points[..., 1], ground[..., 1]], axis=-1)
    return placed.astype(points.dtype, copy=False)


def compose(outer: Placement, inner: Placement) -> Placement:
    """The placement that does `inner` first and `outer` after it."""
    return Placement(
        _wrap(outer.yaw + inner.yaw), rotate_ground(np.asarray(inner.offset), outer.yaw) + outer.offset
    )


def inverse(placement: Placement) -> Placement:
    """The placement that undoes a placement."""
    return Placement(_wrap(-placement.yaw), -rotate_ground(np.asarray(placement.offset), -placement.yaw))


def _wrap(angle: float) -> float:
    return float(np.arctan2(np.sin(angle), np.cos(angle)))
