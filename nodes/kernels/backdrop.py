"""A plain stage behind and under the performer: a grey floor with a soft shadow and a metre grid."""

from __future__ import annotations

import cv2
import numpy as np

from reperform.nodes.kernels.rasterise import rasterise

# Towards the light: high, from the front left.
LIGHT = np.array([-0.35, 1.0, 0.3])


def backdrop(
    matrix: np.ndarray,
    rotation: np.ndarray,
    translation: np.ndarray,
    height: int,
    width: int,
    vertices: np.ndarray,
    faces: np.ndarray,
    *,
    brightness: float = 0.75,
    shadow: float = 0.5,
    grid: float = 1.0,
) -> np.ndarray:
    """The stage (height, width, 3) float32, 0..255, as an undistorted camera sees it.

    Floor at y = 0, `grid` m between its lines (0: none), fading with distance into the wall so that no
    horizon shows. The mesh (vertices (V, 3) m, faces) darkens the floor by `shadow`: its projection along
    the light, blurred with sigma 3 cm and 12 cm.
    """
    y, x = np.mgrid[:height, :width]
    inverse = np.linalg.inv(matrix)
    directions = (np.stack([x, y, np.ones_like(x)], -1) @ inverse.T) @ rotation
    eye = -rotation.T @ translation
    wall = brightness * 255 * (0.92 + 0.08 * (1 - y / max(height - 1, 1)))
    down = directions[..., 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = np.where(down < -1e-6, -eye[1] / down, np.inf)
        reach = np.where(reach > 0, reach, np.inf)
        spot_x, spot_z = eye[0] + reach * directions[..., 0], eye[2] + reach * directions[..., 2]
        away = reach * np.linalg.norm(directions[..., [0, 2]], axis=-1)
    on_floor = away < 40.0
    fade = np.where(on_floor, np.exp(-np.square(np.where(on_floor, away, 0) / 9.0)), 0.0)
    tone = wall * (1 + 0.10 * fade)
    if grid > 0:
        footprint = np.where(on_floor, reach, 1.0) / matrix[0, 0]
        lines = np.maximum(_line(spot_x, grid, footprint), _line(spot_z, grid, footprint))
        tone = tone * (1 - 0.16 * np.where(on_floor, lines, 0) * fade)
    if shadow > 0 and len(faces):
        darkness, origin, cell = _shadow_map(vertices, faces)
        column = np.where(on_floor, (spot_x - origin[0]) / cell, -9.0).astype(np.float32)
        row = np.where(on_floor, (spot_z - origin[1]) / cell, -9.0).astype(np.float32)
        tone = tone * (1 - shadow * cv2.remap(darkness, column, row, cv2.INTER_LINEAR))
    return np.repeat(np.clip(tone, 0, 255).astype(np.float32)[..., None], 3, axis=-1)


def _line(coordinate: np.ndarray, grid: float, footprint: np.ndarray) -> np.ndarray:
    """How much of a pixel lies on a 1.5 cm line of the grid, 0..1."""
    with np.errstate(invalid="ignore"):
        offset = np.abs((coordinate / grid + 0.5) % 1.0 - 0.5) * grid
    half = 0.0075
    width = np.maximum(footprint, 1e-4)
    covered = np.clip((half - offset) / width + 0.5, 0, 1) * np.minimum(1.0, 2 * half / width)
    return np.nan_to_num(covered)


def _shadow_map(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Darkness of the floor (rows along z, columns along x), its first cell's centre (x, z) and cell size in
    m."""
    cell, margin = 0.02, 0.5
    flat = vertices[:, [0, 2]] - np.maximum(vertices[:, 1:2], 0) / LIGHT[1] * LIGHT[[0, 2]]
    origin = flat.min(axis=0) - margin
    columns, rows = (np.ceil((flat.max(axis=0) + margin - origin) / cell).astype(int) + 1).tolist()
    ids, _, _ = rasterise((flat - origin) / cell, np.ones(len(flat)), faces, rows, columns)
    hit = (ids >= 0).astype(np.float32)
    darkness = 0.45 * cv2.GaussianBlur(hit, (0, 0), 0.03 / cell) + 0.55 * cv2.GaussianBlur(
        hit, (0, 0), 0.12 / cell
    )
    return darkness, origin, cell
