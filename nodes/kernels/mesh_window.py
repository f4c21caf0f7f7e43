"""A mesh as each camera of a rig sees it, drawn in the part of the picture that shows it."""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np

from reperform.nodes.kernels.camera import centre, project
from reperform.nodes.kernels.rasterise import rasterise

Rig = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
# Pixels kept free round the mesh, so that its outline lies inside the window.
MARGIN = 8


class MeshWindow(NamedTuple):
    """One camera's view of a mesh."""

    low: np.ndarray  # (2,) int: x, y of the window's first pixel
    pixels: np.ndarray  # (V, 2) float32 px in the window; nan where a vertex is not before the camera
    range: np.ndarray  # (V,) m along the optical axis
    cosine: np.ndarray  # (V,) of the angle between a vertex's normal and the direction to the camera
    depth: np.ndarray  # (h, w) float32 m, inf = nothing drawn
    focal: float  # px


def mesh_windows(
    vertices: np.ndarray, normals: np.ndarray, faces: np.ndarray, rig: Rig, size: tuple[int, int]
) -> list[MeshWindow | None]:
    """Draw a mesh in every camera; None where it is out of the picture. size: height, width of the pictures."""
    windows: list[MeshWindow | None] = []
    for k in range(len(rig[0])):
        matrix, rotation, translation, lens = (part[k] for part in rig)
        pixels, depth = project(vertices, matrix, rotation, translation, lens)
        seen = np.isfinite(pixels).all(axis=1)
        if not seen.any():
            windows.append(None)
            continue
        low = np.maximum(np.floor(pixels[seen].min(axis=0)).astype(int) - MARGIN, 0)
        high = np.minimum(np.ceil(pixels[seen].max(axis=0)).astype(int) + MARGIN + 1, size[::-1])
        if (high - low < 3).any():
            windows.append(None)
            continue
        towards = centre(rotation, translation) - vertices
        cosine = (towards * normals).sum(axis=1) / np.linalg.norm(towards, axis=1)
        drawn = rasterise(pixels - low, depth, faces, high[1] - low[1], high[0] - low[0])[2]
        windows.append(
            MeshWindow(low, (pixels - low).astype(np.float32), depth, cosine, drawn, float(matrix[0, 0]))
        )
    return windows


def at_pixels(field: np.ndarray, pixels: np.ndarray, outside: float) -> np.ndarray:
    """A field (h, w) float32 at pixels (N, 2), linear between pixels; `outside` at nan and out of the field."""
    spot = np.nan_to_num(pixels, nan=-1e4).astype(np.float32)[None]
    return np.asarray(
        cv2.remap(field, spot, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=outside)[0]
    )


def visible_views(
    windows: list[MeshWindow | None], most: int, tolerance: float, least_cosine: float
) -> np.ndarray:
    """The `most` cameras (V, most) int32 that see each vertex most nearly along its normal, -1 where there are fewer.

    A vertex is seen where it is at most `tolerance` (m) behind the farthest surface drawn in the 3 x 3 pixels
    around, and its normal turns to the camera by a cosine over `least_cosine`.
    """
    count = next((len(w.cosine) for w in windows if w is not None), 0)
    score = np.full((count, len(windows)), -1.0)
    for k, window in enumerate(windows):
        if window is None:
            continue
        far = cv2.dilate(np.where(np.isfinite(window.depth), window.depth, 0), np.ones((3, 3), np.uint8))
        height, width = far.shape
        spot = np.rint(np.nan_to_num(window.pixels, nan=-1)).astype(int)
        inside = (spot >= 0).all(axis=1) & (spot < (width, height)).all(axis=1)
        spot = np.clip(spot, 0, (width - 1, height - 1))
        seen = inside & (window.range < far[spot[:, 1], spot[:, 0]] + tolerance)
        score[:, k] = np.where(seen & (window.cosine > least_cosine), window.cosine, -1)
    order = np.argsort(-score, axis=1, kind="stable")[:, :most]
    chosen: np.ndarray = np.where(np.take_along_axis(score, order, axis=1) > 0, order, -1).astype(np.int32)
    return chosen
