"""Correct a calibration so that the silhouettes of a rig agree."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.matte_volume import matte_boxes, performer_ball, refuse_mismatch
from reperform.nodes.kernels.silhouette_coherence import common_translation, containing_shift, hull_silhouette
from reperform.nodes.kernels.visual_hull import Rig
from reperform.nodes.product import Dataset
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.footage import Mattes

# Part of the found shift that is applied at once: the cameras move together.
_STEP = 0.7
# A sweep that moves no camera by more than this (px) is the last.
_SETTLED = 0.3


@node(over="dataset", memory=2.0)
def refine_calibration(
    mattes: Dataset[Mattes],
    cameras: Dataset[Cameras],
    *,
    frames: Annotated[int, Param("frame", 1, 100, "used, evenly spread over the takes of a rig")] = 3,
    sweeps: Annotated[int, Param("sweep", 0, 50, "over all cameras at most")] = 4,
    limit: Annotated[int, Param("px", 1, 200, "largest shift in one sweep")] = 16,
    stiffness: Annotated[
        float, Param("1/px^2", 0, 1, "share of the matte that a shift of 1 px must win")
    ] = 2e-5,
    voxel: Annotated[float, Param("m", 0.002, 0.1, "of the hulls compared")] = 0.02,
    floor: Annotated[float, Param("m", -100, 100, "height below which nothing is")] = -0.05,
) -> Dataset[Cameras]:
    """The rig with principal points moved so that each matte lies within the hull of all the others.

    alpha (frame, camera, y, x) -> cameras. True silhouettes are coherent: each is contained in the outline of the
    hull of the others. For each camera in turn the shift d (px) of the picture plane is sought that leaves least
    of its mattes outside: min_d uncovered(d) / area + `stiffness` |d|^2, and the principal point moves by 0.7 d;
    sweeps go on until no camera moves by more than 0.3 px. What is a common translation of the world is taken out
    in the end. Takes with the same calibration are one rig and get the same correction.

    A shift stands for the small errors of pose and principal point that a fixed calibration keeps; it does not
    replace one. Raises ValueError where calibration and mattes do not match in number or size.
    Source: Boyer 2006, ACCV, "On using silhouettes for camera calibration"; Hernandez, Schmitt and Cipolla 2007,
    PAMI (silhouette coherence).
    """
    refined: dict[str, Cameras] = {}
    for takes in _rigs(cameras):
        first = Cameras(*(np.asarray(field) for field in cameras[takes[0]]))
        pictures = _chosen(mattes, takes, frames)
        for alpha in pictures:
            refuse_mismatch("refine_calibration", alpha.shape, first.image_size, first.name)
        matrix = _coherent(pictures, first, sweeps, limit, stiffness, voxel, floor)
        refined |= {take: first._replace(matrix=matrix) for take in takes}
    return {take: refined[take] for take in cameras}


def _rigs(cameras: Dataset[Cameras]) -> list[list[str]]:
    """Takes with the same calibration, in groups."""
    groups: dict[bytes, list[str]] = {}
    for take, rig in cameras.items():
        key = b"".join(np.ascontiguousarray(field).tobytes() for field in rig[:5])
        groups.setdefault(key, []).append(take)
    return list(groups.values())


def _chosen(mattes: Dataset[Mattes], takes: list[str], frames: int) -> list[np.ndarray]:
    """Mattes (camera, y, x) of some frames of some takes in which every camera sees the performer."""
    places = [(take, k) for take in takes for k in range(mattes[take].alpha.shape[0])]
    picks = np.unique(np.linspace(0, len(places) - 1, min(frames, len(places))).round().astype(int))
    pictures = []
    for take, frame in (places[pick] for pick in picks):
        alpha = mattes[take].alpha
        picture = np.stack([np.asarray(alpha[frame, camera]) for camera in range(alpha.shape[1])])
        if np.isfinite(matte_boxes(picture)).all():
            pictures.append(picture)
    return pictures


def _coherent(
    pictures: list[np.ndarray],
    rig: Cameras,
    sweeps: int,
    limit: int,
    stiffness: float,
    voxel: float,
    floor: float,
) -> np.ndarray:
    """Camera matrices (camera, 3, 3) after the sweeps."""
    matrix = rig.matrix.copy()
    if len(rig.name) < 3:
        return matrix
    for _ in range(sweeps if pictures else 0):
        moved = np.zeros((len(matrix), 2))
        for camera in range(len(matrix)):
            model: Rig = (matrix, rig.rotation, rig.translation, rig.distortion)
            found = []
            for alpha in pictures:
                outline = hull_silhouette(alpha, model, camera, voxel, floor)
                if outline is not None:
                    found.append(containing_shift(alpha[camera], outline, limit, stiffness))
            if found:
                moved[camera] = np.median(found, axis=0)
                matrix[camera, :2, 2] += _STEP * moved[camera]
        if np.abs(moved).max() <= _SETTLED:
            break
    shifts = (matrix - rig.matrix)[:, :2, 2]
    if pictures and shifts.any():
        point = performer_ball(matte_boxes(pictures[0]), matrix, rig.rotation, rig.translation)[0]
        model = (matrix, rig.rotation, rig.translation, rig.distortion)
        matrix[:, :2, 2] -= common_translation(shifts, model, point)
    return matrix
