"""How far each camera's silhouette must move so that those of the others contain it."""

from __future__ import annotations

import cv2
import numpy as np

from reperform.nodes.kernels.flying_edges import isosurface
from reperform.nodes.kernels.largest_component import largest_component
from reperform.nodes.kernels.matte_volume import matte_boxes
from reperform.nodes.kernels.silhouette import silhouette
from reperform.nodes.kernels.visual_hull import Rig, visual_hull


def hull_silhouette(
    alpha: np.ndarray, rig: Rig, camera: int, voxel: float, floor: float
) -> np.ndarray | None:
    """What one camera would see (y, x) bool of the hull of all the others; None where they share nothing."""
    others = np.arange(len(alpha)) != camera
    part = (rig[0][others], rig[1][others], rig[2][others], rig[3][others])
    hull = visual_hull(
        alpha[others], part, matte_boxes(alpha[others]), voxel, 0, int(others.sum()) // 2 + 1, floor
    )
    if hull is None or not (hull[0] > 0.5).any():
        return None
    points, faces = largest_component(*isosurface(hull[0], 0.5))
    world = hull[1] + voxel * points
    return silhouette(world, faces, *(part[camera] for part in rig), *alpha.shape[1:])


def containing_shift(matte: np.ndarray, outline: np.ndarray, limit: int, stiffness: float) -> np.ndarray:
    """Shift (2,) px, x and y, of an outline that leaves least of a matte uncovered.

    matte (y, x) uint8, outline (y, x) bool. Minimises uncovered(d) / area + stiffness |d|^2 over whole shifts with
    |dx|, |dy| <= limit, then to parts of a pixel by the parabola through the minimum.
    """
    top, bottom, left, right = matte_window(matte)
    inside = (matte[top:bottom, left:right] > 127).astype(np.float32)
    padded = np.pad(outline, limit)[top : bottom + 2 * limit, left : right + 2 * limit].astype(np.float32)
    # entry (limit + b, limit + a): area of the matte that the outline covers when moved by (-a, -b)
    covered = cv2.matchTemplate(padded, inside, cv2.TM_CCORR)[::-1, ::-1]
    away = np.arange(-limit, limit + 1, dtype=np.float64)
    cost = 1 - covered.astype(np.float64) / inside.sum()
    cost += stiffness * (away[:, None] ** 2 + away[None, :] ** 2)
    row, column = (int(n) for n in np.unravel_index(cost.argmin(), cost.shape))
    return np.array(
        [away[column] + _parabola(cost[row], column), away[row] + _parabola(cost[:, column], row)]
    )


def common_translation(shifts: np.ndarray, rig: Rig, point: np.ndarray) -> np.ndarray:
    """The part (camera, 2) of shifts in px that is one translation of the world, seen at `point` (3,) metres.

    Least squares: min_t sum_c |d_c - J_c t|^2 with J_c the derivative of the pixel of `point` by its position.
    """
    matrix, rotation, translation = rig[:3]
    camera = np.einsum("cij,j->ci", rotation, point) + translation
    slope = np.zeros((len(camera), 2, 3))
    slope[:, 0, 0] = slope[:, 1, 1] = 1 / camera[:, 2]
    slope[:, :, 2] = -camera[:, :2] / camera[:, 2:] ** 2
    slope = np.einsum("cij,cjk,ckl->cil", matrix[:, :2, :2], slope, rotation)
    move = np.linalg.lstsq(slope.reshape(-1, 3), shifts.ravel(), rcond=None)[0]
    return slope @ move


def _parabola(values: np.ndarray, at: int) -> float:
    if at in (0, len(values) - 1):
        return 0.0
    left, middle, right = values[at - 1], values[at], values[at + 1]
    bend = left - 2 * middle + right
    return float(0.5 * (left - right) / bend) if bend > 0 else 0.0


def matte_window(matte: np.ndarray) -> tuple[int, int, int, int]:
    """Top, bottom, left, right of what is more covered than not; ends are exclusive."""
    mask = matte > 127
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return int(rows[0]), int(rows[-1]) + 1, int(columns[0]), int(columns[-1]) + 1
