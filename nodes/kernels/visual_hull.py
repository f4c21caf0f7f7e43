"""The fractional visual hull of mattes on a grid that it finds itself."""

from __future__ import annotations

import numpy as np

from reperform.nodes.kernels.matte_volume import performer_ball
from reperform.nodes.kernels.voxel_carving import camera_rows, carve, integral_images, may_be_occupied

_BLOCK = 4
# Cells along the longest edge of the first, coarse grid.
_COARSE = 40
_MOST_VOXELS = 400_000_000

Rig = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def visual_hull(
    alpha: np.ndarray, rig: Rig, boxes: np.ndarray, voxel: float, misses: int, views: int, floor: float
) -> tuple[np.ndarray, np.ndarray] | None:
    """Field of occupancy (x, y, z) float32 and the centre (3,) of its first voxel; None where nothing is common.

    alpha (camera, y, x) uint8; rig: matrix, rotation, translation, distortion of the cameras; boxes (camera, 4):
    `matte_boxes`, nan for an empty matte; voxel, floor in metres; misses, views as in `carve`. The grid starts as
    the cube around `performer_ball`, grows where the hull touches its sides, and is then cut to the hull. Below
    `floor` the field falls to 0 within a voxel.
    Raises ValueError where more voxels were needed than fit in memory.
    """
    rows = camera_rows(*rig)
    sums = integral_images(alpha)
    shown = np.isfinite(boxes[:, 0])
    middle, radius = performer_ball(boxes[shown], *(part[shown] for part in rig[:3]))
    box = _hull_box(sums, rows, middle - radius, middle + radius, misses, views, floor - voxel)
    if box is None:
        return None
    edge = _BLOCK * voxel
    origin = np.floor(box[0] / edge) * edge
    origin[1] = max(origin[1], np.floor(floor / voxel - 1) * voxel)
    count = np.ceil((box[1] - origin) / edge).astype(int)
    if np.prod(count.astype(float)) * _BLOCK**3 > _MOST_VOXELS:
        raise ValueError(
            f"visual hull: {np.prod(count.astype(float)) * _BLOCK**3:.0f} voxels of {voxel} m would be needed: "
            "enlarge voxel, or check that mattes and calibration belong together"
        )
    blocks = may_be_occupied(
        sums, rows, origin + 0.5 * (edge - voxel), edge, tuple(int(n) for n in count), misses, views
    )
    field = np.zeros(count * _BLOCK, np.float32)
    carve(sums, rows, origin, voxel, blocks, _BLOCK, misses, views, field)
    height = origin[1] + voxel * np.arange(field.shape[1])
    above = np.clip(0.5 + (height - floor) / voxel, 0, 1).astype(np.float32)
    np.minimum(field, above[:, None], out=field)
    return field, origin


def _hull_box(
    sums: np.ndarray,
    rows: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    misses: int,
    views: int,
    bottom: float,
) -> tuple[np.ndarray, np.ndarray] | None:
    """Bounds (m) of what may be occupied, looked for in a box that grows where it is touched."""
    found = None
    for _ in range(6):
        low[1] = max(low[1], bottom)
        high[1] = max(high[1], bottom + 0.1)
        size = float((high - low).max()) / _COARSE
        count = np.maximum(np.ceil((high - low) / size).astype(int), 1)
        shape = (int(count[0]), int(count[1]), int(count[2]))
        cells = np.argwhere(may_be_occupied(sums, rows, low + 0.5 * size, size, shape, misses, views))
        if not len(cells):
            return found
        first, last = cells.min(axis=0), cells.max(axis=0)
        found = low + size * first, low + size * (last + 1)
        at_low, at_high = first == 0, last == count - 1
        at_low[1] &= low[1] > bottom
        if not (at_low.any() or at_high.any()):
            break
        extent = high - low
        low, high = low - 0.5 * extent * at_low, high + 0.5 * extent * at_high
    return found
