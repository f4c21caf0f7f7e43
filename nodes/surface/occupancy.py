"""The visual hull as a field of probabilities."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.matte_volume import matte_boxes, performer_ball
from reperform.nodes.kernels.voxel_carving import camera_rows, carve, integral_images, may_be_occupied
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.footage import Mattes
from reperform.nodes.products.mesh import Occupancy

_BLOCK = 8
# Cells along the edge of the first, coarse grid.
_COARSE = 40
_MOST_VOXELS = 400_000_000


@node(over="frame", memory=1.0)
def occupancy(
    mattes: Mattes,
    cameras: Cameras,
    *,
    voxel: Annotated[float, Param("m", 0.001, 0.2, "edge of one voxel")] = 0.01,
    misses: Annotated[int, Param("cameras", 0, 8, "mattes that may be wrong at any place")] = 0,
    views: Annotated[int, Param("cameras", 0, 64, "that must see a place; 0: more than half")] = 0,
    floor: Annotated[float, Param("m", -100, 100, "height below which nothing is")] = 0.0,
) -> Occupancy:
    """Probability that each voxel belongs to the performer, on a grid that just holds the performer.

    alpha (camera, y, x) and calibrated cameras -> probability (x, y, z). p_c is the mean of alpha_c over the voxel's
    footprint in camera c (a square of voxel f / z px, through the lens model); with odds against
    o_c = (1 - p_c) / p_c and the `misses` largest of them left out, p = 1 / (1 + sum_c o_c). The surface p = 0.5
    is where one camera's footprint is half covered and the others' wholly: sub-voxel exact on smooth silhouettes.
    Cameras that do not see a voxel say nothing about it. Below `floor` p falls to 0 within a voxel.

    Raises ValueError naming the cameras for mattes that are empty (more than `misses` of them), for mattes whose
    number or size is not the calibration's, and for mattes that have no common volume.
    Source: 003 eqs 1-4; Laurentini 1994, PAMI (visual hull); Franco and Boyer 2005, ICCV (occupancy fusion).
    Departure: eq 4's product of logistics is a sum of odds with k-of-n tolerance, so that p = 0.5 is the hull;
    footprints instead of single pixels; places out of a camera's view are unknown, not empty (eq 4 says nothing).
    """
    alpha = np.ascontiguousarray(mattes.alpha)
    _refuse_mismatch(alpha, cameras)
    boxes = matte_boxes(alpha)
    used = _usable(boxes, cameras, misses)
    least = views or len(cameras.name) // 2 + 1
    rows = camera_rows(cameras.matrix, cameras.rotation, cameras.translation, cameras.distortion)
    sums = integral_images(alpha)
    ball = performer_ball(
        boxes[used], cameras.matrix[used], cameras.rotation[used], cameras.translation[used]
    )
    origin, shape, blocks = _grid(sums, rows, ball, voxel, misses, least, floor)
    field = np.zeros(shape, np.float32)
    carve(sums, rows, origin, voxel, blocks, _BLOCK, misses, least, field)
    height = origin[1] + voxel * np.arange(shape[1], dtype=np.float32)
    below = np.clip(0.5 + (height - floor) / voxel, 0, 1).astype(np.float32)
    np.minimum(field, below[:, None], out=field)
    return Occupancy(field, origin.astype(np.float32), np.float32(voxel), mattes.fps)


def _refuse_mismatch(alpha: np.ndarray, cameras: Cameras) -> None:
    if len(alpha) != len(cameras.name):
        raise ValueError(
            f"occupancy: as many mattes as cameras are needed, got {len(alpha)} mattes and {len(cameras.name)} "
            f"cameras ({', '.join(map(str, cameras.name))}): choose the same cameras for both"
        )
    size = alpha.shape[2], alpha.shape[1]
    for name, (width, height) in zip(cameras.name, cameras.image_size, strict=True):
        if (width, height) != size:
            raise ValueError(
                f"occupancy: the calibration of camera {name} is for images of {width}x{height} px, its mattes have "
                f"{size[0]}x{size[1]} px: scale the pictures or take the calibration that belongs to them"
            )


def _usable(boxes: np.ndarray, cameras: Cameras, misses: int) -> np.ndarray:
    used = np.isfinite(boxes[:, 0])
    if (~used).sum() > misses or used.sum() < 2:
        raise ValueError(
            f"occupancy: the matte of camera {', '.join(map(str, cameras.name[~used]))} is empty: correct the key, "
            f"leave the camera out, or allow it with misses (now {misses}); at least 2 mattes must show something"
        )
    return used


def _grid(
    sums: np.ndarray,
    rows: np.ndarray,
    ball: tuple[np.ndarray, float],
    voxel: float,
    misses: int,
    views: int,
    floor: float,
) -> tuple[np.ndarray, tuple[int, int, int], np.ndarray]:
    """Origin and shape of the voxel grid, and which of its blocks may hold something."""
    low, high = ball[0] - ball[1], ball[0] + ball[1]
    for _ in range(6):
        low[1] = max(low[1], floor - voxel)
        found = _occupied_box(sums, rows, low, high, misses, views)
        if found is None:
            raise ValueError(
                f"occupancy: the mattes have no volume in common near ({ball[0][0]:.2f}, {ball[0][1]:.2f}, "
                f"{ball[0][2]:.2f}) m: check that mattes and calibration belong together, or raise misses (now {misses})"
            )
        inner_low, inner_high, open_sides = found
        if not open_sides.any():
            break
        extent = high - low
        low, high = low - 0.5 * extent * open_sides[0], high + 0.5 * extent * open_sides[1]
    edge = _BLOCK * voxel
    origin = np.floor(inner_low / edge) * edge
    origin[1] = max(origin[1], np.floor((floor - voxel) / voxel) * voxel)
    count = np.ceil((inner_high - origin) / edge).astype(int)
    if np.prod(count.astype(float)) * _BLOCK**3 > _MOST_VOXELS:
        raise ValueError(
            f"occupancy: {np.prod(count.astype(float)) * _BLOCK**3:.0f} voxels of {voxel} m would be needed: enlarge "
            "voxel, or check that mattes and calibration belong together"
        )
    shape = (int(count[0]), int(count[1]), int(count[2]))
    blocks = may_be_occupied(sums, rows, origin + 0.5 * (edge - voxel), edge, shape, misses, views)
    return origin, (shape[0] * _BLOCK, shape[1] * _BLOCK, shape[2] * _BLOCK), blocks


def _occupied_box(
    sums: np.ndarray, rows: np.ndarray, low: np.ndarray, high: np.ndarray, misses: int, views: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """Bounds of the occupied cells of a coarse grid over a box, and which sides of the box they touch (2, 3)."""
    size = float((high - low).max()) / _COARSE
    count = np.maximum(np.ceil((high - low) / size).astype(int), 1)
    shape = (int(count[0]), int(count[1]), int(count[2]))
    cells = np.argwhere(may_be_occupied(sums, rows, low + 0.5 * size, size, shape, misses, views))
    if not len(cells):
        return None
    first, last = cells.min(axis=0), cells.max(axis=0)
    touched = np.stack([first == 0, last == count - 1])
    # the floor is a side that may be touched
    touched[0, 1] = False
    return low + size * first, low + size * (last + 1), touched
