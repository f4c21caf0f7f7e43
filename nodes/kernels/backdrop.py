"""A plain stage behind and under the performer: a grey floor with a soft shadow and a metre grid."""

from __future__ import annotations

import cv2
import numpy as np
from numba import njit

from reperform.nodes.kernels.rasterise import rasterise

# Towards the light: high, from the front left.
LIGHT = np.array([-0.35, 1.0, 0.3])
# Metres: where the floor ends, and over which distance it fades.
FAR = 40.0
FADE = 9.0


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
    if shadow > 0 and len(faces):
        darkness, origin, cell = _shadow_map(vertices, faces)
    else:
        darkness, origin, cell = np.zeros((2, 2), np.float32), np.zeros(2), 1.0
    # Columns: the ray's direction in the world for one pixel to the right, one down, and at pixel (0, 0).
    rays = rotation.T @ np.linalg.inv(matrix)
    tone = _tone(
        np.ascontiguousarray(rays, np.float64),
        np.ascontiguousarray(-rotation.T @ translation, np.float64),
        height,
        width,
        float(matrix[0, 0]),
        255.0 * brightness,
        shadow,
        grid,
        darkness,
        origin,
        cell,
    )
    return np.repeat(tone[..., None], 3, axis=-1)


@njit(cache=True, nogil=True)
def _tone(
    rays: np.ndarray,
    eye: np.ndarray,
    height: int,
    width: int,
    focal: float,
    brightness: float,
    shadow: float,
    grid: float,
    darkness: np.ndarray,
    origin: np.ndarray,
    cell: float,
) -> np.ndarray:
    """Grey (height, width) float32 of wall, floor, lines and shadow."""
    tone = np.empty((height, width), np.float32)
    for row in range(height):
        wall = brightness * (1 - 0.08 * row / max(height - 1, 1))
        for column in range(width):
            tone[row, column] = wall
            down = rays[1, 0] * column + rays[1, 1] * row + rays[1, 2]
            if down * eye[1] >= 0:
                continue
            reach = -eye[1] / down
            dx = reach * (rays[0, 0] * column + rays[0, 1] * row + rays[0, 2])
            dz = reach * (rays[2, 0] * column + rays[2, 1] * row + rays[2, 2])
            squared = dx * dx + dz * dz
            if squared > FAR * FAR:
                continue
            fade = np.exp(-squared / (FADE * FADE))
            x, z = eye[0] + dx, eye[2] + dz
            lit = wall * (1 + 0.10 * fade)
            if grid > 0:
                line = max(_line(x, grid, reach / focal), _line(z, grid, reach / focal))
                lit *= 1 - 0.16 * line * fade
            if shadow > 0:
                lit *= 1 - shadow * _bilinear(darkness, (z - origin[1]) / cell, (x - origin[0]) / cell)
            tone[row, column] = min(255.0, lit)
    return tone


@njit(cache=True, nogil=True)
def _line(coordinate: float, grid: float, footprint: float) -> float:
    """How much of a pixel lies on a 1.5 cm line of the grid, 0..1."""
    half = 0.0075
    offset = abs((coordinate / grid + 0.5) % 1.0 - 0.5) * grid
    covered = min(1.0, max(0.0, (half - offset) / footprint + 0.5))
    return covered * min(1.0, 2 * half / footprint)


@njit(cache=True, nogil=True)
def _bilinear(field: np.ndarray, row: float, column: float) -> float:
    """Value between four cells; 0 outside."""
    if not (row >= 0 and column >= 0 and row < field.shape[0] - 1 and column < field.shape[1] - 1):
        return 0.0
    r, c = int(row), int(column)
    a, b = row - r, column - c
    return (1 - a) * ((1 - b) * field[r, c] + b * field[r, c + 1]) + a * (
        (1 - b) * field[r + 1, c] + b * field[r + 1, c + 1]
    )


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
