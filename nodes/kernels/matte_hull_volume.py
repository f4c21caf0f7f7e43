"""The volume of the visual hull of mattes, by halving the cells that its surface may cross."""

from __future__ import annotations

import cv2
import numpy as np

from reperform.nodes.kernels.camera import project

Rig = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
_HALVINGS = 4
# How much farther than f / z pixels per metre a lens may stretch the picture, and the nearer side of a cell.
_STRETCH = 1.25


def matte_hull_volume(
    alpha: np.ndarray, rig: Rig, low: np.ndarray, high: np.ndarray, voxel: float, views: int
) -> float:
    """Volume, m^3, of the voxels in the box low .. high (3,) m whose centre every camera that sees it shows covered.

    alpha (camera, y, x) uint8, covered where its bilinear value is at least 1/2; rig: matrix, rotation, translation,
    distortion of the cameras; voxel: edge in metres; places seen by fewer than `views` cameras are empty. Cells of
    2^4 voxels are settled as wholly empty or wholly full where the mattes leave no doubt, else halved: the same
    count as voxel by voxel.
    """
    size = voxel * 2**_HALVINGS
    counts = np.maximum(np.ceil((high - low) / size).astype(int), 1)
    cells = low + size * (
        np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), -1).reshape(-1, 3) + 0.5
    )
    total = 0.0
    for _ in range(_HALVINGS):
        full, doubtful = _settled(alpha, rig, cells, size, views)
        total += float(full.sum()) * size**3
        size *= 0.5
        cells = (cells[doubtful][:, None] + size * _CORNERS).reshape(-1, 3)
    return total + float(_covered(alpha, rig, cells, views).sum()) * size**3


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


def _covered(alpha: np.ndarray, rig: Rig, points: np.ndarray, views: int) -> np.ndarray:
    """Points (N, 3) that are covered in every camera that sees them, and seen by `views` at least."""
    seen, inside = np.zeros(len(points), int), np.ones(len(points), bool)
    height, width = alpha.shape[1:]
    for picture, *camera in zip(alpha, *rig, strict=True):
        rest = np.flatnonzero(inside)
        pixels = np.nan_to_num(project(points[rest], *camera)[0], nan=-1e6).astype(np.float32)
        sees = (pixels > -0.5).all(axis=1) & (pixels[:, 0] < width - 0.5) & (pixels[:, 1] < height - 0.5)
        inside[rest[sees]] = _bilinear(picture, pixels[sees]) >= 127.5
        seen[rest[sees]] += 1
    return inside & (seen >= views)


def _bilinear(picture: np.ndarray, pixels: np.ndarray) -> np.ndarray:
    """Values (N,) at pixel positions (N, 2), the border repeated."""
    height, width = picture.shape
    corner = np.floor(pixels).astype(int)
    share = pixels - corner
    x0, y0 = np.clip(corner, 0, (width - 1, height - 1)).T
    x1, y1 = np.clip(corner + 1, 0, (width - 1, height - 1)).T
    top = picture[y0, x0] * (1 - share[:, 0]) + picture[y0, x1] * share[:, 0]
    bottom = picture[y1, x0] * (1 - share[:, 0]) + picture[y1, x1] * share[:, 0]
    return top * (1 - share[:, 1]) + bottom * share[:, 1]
