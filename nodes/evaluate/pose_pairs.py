"""Pairs of poses to be blended."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.coarse_topology import coarse_topology
from reperform.nodes.kernels.ground_plane import align, apply
from reperform.nodes.product import Dataset
from reperform.nodes.products.blend_measures import PosePairs
from reperform.nodes.products.mesh import MeshSequence

_WHO = "evaluate.pose_pairs"


@node(over="dataset")
def pose_pairs(
    meshes: Dataset[MeshSequence],
    truth: Dataset[MeshSequence] | None = None,
    *,
    pairs: Annotated[
        tuple[str, ...],
        Param(
            "",
            about="NAME FIRST SECOND [MIDDLE], each pose TAKE:FRAME, FRAME a number, `highest`, `lowest` or `like` "
            "(most like the first pose)",
        ),
    ],
    vertices: Annotated[int, Param("1", 100, 1000000, "vertices to keep, about")] = 1000000,
) -> PosePairs:
    """Chosen poses of takes of one topology, the second (and the true middle) laid on the first on the ground.

    The ground-plane motion is that of least squares over all vertices, m. Middles are looked for in `truth` too.
    With fewer vertices, all poses share the topology that decimating the first pose gives.

    Raises ValueError where a pair cannot be read, a take or frame is not there, or topologies differ.
    Source: Kovar, Gleicher and Pighin 2002, SIGGRAPH (the ground-plane motion).
    """
    known = {**(truth or {}), **meshes}
    faces = np.asarray(next(iter(meshes.values())).faces)
    for take, sequence in known.items():
        if not np.array_equal(np.asarray(sequence.faces), faces):
            raise ValueError(f"{_WHO}: takes must share one topology; {take} differs: align them first")
    names, rows = [], []
    for text in pairs:
        name, *poses = text.split()
        if len(poses) not in (2, 3):
            raise ValueError(f"{_WHO}: a pair is NAME FIRST SECOND [MIDDLE], got {text!r}")
        first = _pose(known, poses[0], None)
        others = [_laid(first, _pose(known, pose, first)) for pose in poses[1:]]
        names.append(name)
        rows.append([first, *others] + [np.full_like(first, np.nan)] * (3 - len(poses)))
    stacked = np.array(rows, np.float32)
    coarse = coarse_topology(stacked[0, 0], faces, vertices)
    stacked = coarse.apply(stacked)
    return PosePairs(np.array(names), stacked[:, 0], stacked[:, 1], stacked[:, 2], coarse.faces)


def _pose(known: Dataset[MeshSequence], text: str, first: np.ndarray | None) -> np.ndarray:
    take, _, frame = text.partition(":")
    if take not in known:
        raise ValueError(f"{_WHO}: no take {take!r}; there are {', '.join(known)}")
    vertices = np.asarray(known[take].vertices)
    if frame in ("highest", "lowest"):
        height = vertices[..., 1].mean(axis=1)
        return np.asarray(vertices[int(np.argmax(height if frame == "highest" else -height))])
    if frame == "like" and first is not None:
        step = max(1, len(first) // 400)
        gaps = [align(first[::step], pose[::step])[1] for pose in vertices]
        return np.asarray(vertices[int(np.argmin(gaps))])
    if not frame.isdigit() or int(frame) >= len(vertices):
        raise ValueError(
            f"{_WHO}: a pose is TAKE:FRAME with FRAME in 0 .. {len(vertices) - 1}, highest, lowest or (not for the "
            f"first) like, got {text!r}"
        )
    return np.asarray(vertices[int(frame)])


def _laid(first: np.ndarray, pose: np.ndarray) -> np.ndarray:
    return apply(pose, align(first, pose)[0])
