"""The visual hull as a field of probabilities."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.matte_volume import matte_boxes, refuse_mismatch
from reperform.nodes.kernels.visual_hull import visual_hull
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.footage import Mattes
from reperform.nodes.products.mesh import Occupancy


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

    alpha (camera, y, x) and calibrated cameras -> probability (x, y, z). p_c is the mean of alpha_c over the
    voxel's footprint in camera c (a square of voxel f / z px, through the lens model); with odds against
    o_c = (1 - p_c) / p_c and the `misses` largest of them left out, p = 1 / (1 + sum_c o_c). The surface p = 0.5
    is where one camera's footprint is half covered and the others' wholly: sub-voxel exact on smooth silhouettes.
    Cameras that do not see a voxel say nothing about it. Below `floor` p falls to 0 within a voxel.

    Raises ValueError naming the cameras for mattes that are empty (more than `misses` of them), for mattes whose
    number or size is not the calibration's, and for mattes that have no common volume.
    Source: 003 eqs 1-4; Laurentini 1994, PAMI (visual hull); Franco and Boyer 2005, ICCV (occupancy fusion).
    Departure: eq 4's product of logistics is a sum of odds with k-of-n tolerance, so that p = 0.5 is the hull;
    footprints instead of single pixels; out of a camera's view is unknown, not empty (eq 4 does not say).
    """
    alpha = np.ascontiguousarray(mattes.alpha)
    refuse_mismatch("occupancy", alpha.shape, cameras.image_size, cameras.name)
    boxes = matte_boxes(alpha)
    _refuse_empty(boxes, cameras, misses)
    rig = (cameras.matrix, cameras.rotation, cameras.translation, cameras.distortion)
    hull = visual_hull(alpha, rig, boxes, voxel, misses, views or len(alpha) // 2 + 1, floor)
    if hull is None:
        raise ValueError(
            f"occupancy: the mattes have no volume in common above {floor} m: check that mattes and calibration "
            f"belong together (unit, up axis, order of cameras), or raise misses (now {misses})"
        )
    return Occupancy(hull[0], hull[1].astype(np.float32), np.asarray(voxel, np.float32), mattes.fps)


def _refuse_empty(boxes: np.ndarray, cameras: Cameras, misses: int) -> None:
    empty = np.isnan(boxes[:, 0])
    if empty.sum() > misses or (~empty).sum() < 2:
        raise ValueError(
            f"occupancy: the matte of camera {', '.join(map(str, cameras.name[empty]))} is empty: correct the key, "
            f"leave the camera out, or allow it with misses (now {misses}); 2 mattes at least must show something"
        )
