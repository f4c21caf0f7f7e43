"""Played motion as an animation, so that texture and measures follow."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.ground_plane import align
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation, Provenance
from reperform.nodes.products.played import Played

_WHO = "synthesis.played_animation"


@node(over="dataset", memory=1.0)
def played_animation(played: Played, meshes: Dataset[MeshSequence]) -> Animation:
    """The motion that a character made, with the two captured frames that weigh most in every frame.

    meshes: the takes that the spaces were made of, as they were captured, m. A frame's two heaviest sources are
    rounded to whole captured frames, their weights scaled to sum 1, and each is placed on the ground where it lies
    closest to the mesh that was played:

        (yaw, offset) = argmin sum_v |x_v - (R_y(yaw) c_v + (offset_x, 0, offset_z))|^2

    The mesh stays as it was played.

    Raises ValueError where a take that was played is missing or has another topology.

    Source: provenance of synthesised motion: 000 section 5; the placement: Kovar, Gleicher and Pighin 2002, SIGGRAPH.
    Departure: blends of more than two frames are told by two, since texture is blended of two.
    """
    takes = [str(take) for take in np.asarray(played.takes)]
    weight = np.asarray(played.weight)
    heaviest = np.argsort(-weight, axis=1, kind="stable")[:, :2]
    share = np.take_along_axis(weight, heaviest, 1)
    take = np.take_along_axis(np.asarray(played.take), heaviest, 1).astype(np.int32)
    moment = np.take_along_axis(np.asarray(played.source_frame), heaviest, 1)
    captured = {k: _captured(takes[k], meshes, played) for k in np.unique(take).tolist()}
    last = np.zeros(len(takes), np.int64)
    for k, vertices in captured.items():
        last[k] = len(vertices) - 1
    frame = np.clip(np.rint(moment), 0, last[take]).astype(np.int32)
    yaw, offset = np.zeros(take.shape), np.zeros((*take.shape, 2))
    for f, shown in enumerate(np.asarray(played.mesh.vertices)):
        for side in (0, 1):
            placed, _ = align(shown, captured[take[f, side]][frame[f, side]])
            yaw[f, side], offset[f, side] = placed
    shares = (share / share.sum(axis=1, keepdims=True)).astype(np.float32)
    return Animation(played.mesh, Provenance(np.array(takes), take, frame, shares, yaw, offset))


def _captured(take: str, meshes: Dataset[MeshSequence], played: Played) -> np.ndarray:
    if take not in meshes:
        raise ValueError(
            f"{_WHO}: {take!r} was played and must be given; the meshes have {', '.join(meshes)}"
        )
    if not np.array_equal(np.asarray(meshes[take].faces), np.asarray(played.mesh.faces)):
        raise ValueError(
            f"{_WHO}: takes must have the topology that was played, {played.mesh.vertices.shape[1]} vertices; "
            f"{take} differs: give the meshes that the spaces were made of"
        )
    return np.asarray(meshes[take].vertices)
