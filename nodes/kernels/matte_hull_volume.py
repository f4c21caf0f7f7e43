"""The volume of the visual hull of mattes, by halving the cells that its surface may cross."""

from __future__ import annotations

import cv2
import numpy as np
from numba import njit

from reperform.nodes.kernels.camera import project, radial_limit

Rig = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
_HALVINGS = 2
_PER_EDGE = 8
# How much farther than f / z pixels per metre a lens may stretch the picture, and the nearer side of a cell.
_STRETCH = 1.25


def matte_hull_volume(
    alpha: np.ndarray, rig: Rig, low: np.ndarray, high: np.ndarray, voxel: float, views: int
) -> float:
    """Volume, m^3, of the voxels in the box low .. high (3,) m whose centre every camera that sees it shows covered.

    alpha (camera, y, x) uint8, covered where its bilinear value is at least 1/2; rig: matrix, rotation, translation,
    distortion of the cameras; voxel: edge in metres; places seen by fewer than `views` cameras are empty. Cells of
    32 and 16 voxels' edge are settled as wholly empty or wholly full where the mattes leave no doubt; in the 8 voxel
    cells that stay in doubt every voxel is tried: the same count as voxel by voxel.
    """
    size = voxel * _PER_EDGE * 2**_HALVINGS
    counts = np.maximum(np.ceil((high - low) / size).astype(int), 1)
    cells = low + size * (
        np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), -1).reshape(-1, 3) + 0.5
    )
    total = 0.0
    for level in range(_HALVINGS + 1):
        full, doubtful = _settled(alpha, rig, cells, size, views)
        total += float(full.sum()) * size**3
        cells = cells[doubtful]
        if level < _HALVINGS:
            size *= 0.5
            cells = (cells[:, None] + size * _CORNERS).reshape(-1, 3)
    return total + _count(alpha, _rows(rig), cells - 0.5 * (size - voxel), voxel, views) * voxel**3


_CORNERS = np.stack(np.meshgrid(*[[-0.5, 0.5]] * 3, indexing="ij"), -1).reshape(8, 3)


def _settled(
    alpha: np.ndarray, rig: Rig, cells: np.ndarray, size: float, views: int
) -> tuple[np.ndarray, np.ndarray]:
    """Which cells (N, 3) of an edge are full, and which are neither full nor empty."""
    radius = 0.5 * np.sqrt(3.0) * size
    empty, unsure = np.zeros(len(cells), bool), np.zeros(len(cells), bool)
    seen, blank = np.zeros(len(cells), int), np.zeros(len(cells), int)
    height, width = alpha.shape[1:]
    for picture, *camera in zip(alpha, *rig, strict=True):
        rest = np.flatnonzero(~empty)
        pixels, depth = project(cells[rest], *camera)
        near = np.isnan(pixels).any(axis=1) | (depth <= 2 * radius)
        focal = max(camera[0][0, 0], camera[0][1, 1])
        reach = _STRETCH * radius * focal / np.maximum(depth - radius, radius) + 1.5
        away = np.maximum.reduce(
            [-pixels[:, 0], -pixels[:, 1], pixels[:, 0] - (width - 1), pixels[:, 1] - (height - 1)]
        )
        outside = ~near & (away > reach)
        whole = ~near & (away < -reach)
        widest = int(np.ceil(reach[~near & ~outside].max(initial=1.0)))
        most, least = _extremes(picture, widest)
        at = np.clip(np.rint(np.nan_to_num(pixels)), 0, (width - 1, height - 1)).astype(int)
        shown, holed = most[at[:, 1], at[:, 0]] >= 128, least[at[:, 1], at[:, 0]] < 128
        seen[rest] += ~outside
        empty[rest] |= whole & ~shown
        blank[rest] += ~outside & ~whole & ~near & ~shown
        unsure[rest] |= ~outside & ~(whole & ~holed)
    empty |= seen - blank < views
    full = ~empty & ~unsure
    return full, ~empty & ~full


def _extremes(picture: np.ndarray, reach: int) -> tuple[np.ndarray, np.ndarray]:
    """Largest and smallest value within `reach` px, along both axes."""
    square = np.ones((2 * reach + 1, 2 * reach + 1), np.uint8)
    return cv2.dilate(picture, square), cv2.erode(picture, square)


def _rows(rig: Rig) -> np.ndarray:
    """Everything of each camera in one row (camera, 27): R, t, K, k1 k2 p1 p2 k3, square of the largest radius."""
    matrix, rotation, translation, distortion = (np.asarray(part, np.float64) for part in rig)
    limits = np.array([radial_limit(lens) ** 2 for lens in distortion])
    flat = (part.reshape(len(part), -1) for part in (rotation, translation, matrix, distortion, limits))
    return np.ascontiguousarray(np.concatenate(list(flat), axis=1))


@njit(cache=True, nogil=True)
def _count(alpha: np.ndarray, rows: np.ndarray, first: np.ndarray, voxel: float, views: int) -> int:
    """Occupied voxels in cells of 8^3, given the centres (N, 3) of their first voxels."""
    found = 0
    for cell in range(len(first)):
        for i in range(_PER_EDGE):
            x = first[cell, 0] + voxel * i
            for j in range(_PER_EDGE):
                y = first[cell, 1] + voxel * j
                for k in range(_PER_EDGE):
                    found += _occupied(alpha, rows, x, y, first[cell, 2] + voxel * k, views)
    return found


@njit(cache=True, nogil=True)
def _occupied(alpha: np.ndarray, rows: np.ndarray, x: float, y: float, z: float, views: int) -> int:
    """1 where every camera that sees a place, and `views` at least, shows it covered."""
    height, width = alpha.shape[1], alpha.shape[2]
    seen = 0
    for camera in range(len(rows)):
        row = rows[camera]
        depth = row[6] * x + row[7] * y + row[8] * z + row[11]
        if depth <= 0:
            continue
        u = (row[0] * x + row[1] * y + row[2] * z + row[9]) / depth
        v = (row[3] * x + row[4] * y + row[5] * z + row[10]) / depth
        square = u * u + v * v
        if square >= row[26]:
            continue
        k1, k2, p1, p2, k3 = row[21], row[22], row[23], row[24], row[25]
        radial = 1 + square * (k1 + square * (k2 + square * k3))
        lens_u = u * radial + 2 * p1 * u * v + p2 * (square + 2 * u * u)
        lens_v = v * radial + p1 * (square + 2 * v * v) + 2 * p2 * u * v
        px = row[12] * lens_u + row[13] * lens_v + row[14]
        py = row[15] * lens_u + row[16] * lens_v + row[17]
        if not (-0.5 < px < width - 0.5 and -0.5 < py < height - 0.5):
            continue
        seen += 1
        left, top = int(np.floor(px)), int(np.floor(py))
        share_x, share_y = px - left, py - top
        x0, x1 = max(left, 0), min(left + 1, width - 1)
        y0, y1 = max(top, 0), min(top + 1, height - 1)
        upper = alpha[camera, y0, x0] * (1 - share_x) + alpha[camera, y0, x1] * share_x
        lower = alpha[camera, y1, x0] * (1 - share_x) + alpha[camera, y1, x1] * share_x
        if upper * (1 - share_y) + lower * share_y < 127.5:
            return 0
    return 1 if seen >= views else 0
