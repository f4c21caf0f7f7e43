"""The mesh sequence of a walk through a pose graph."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Literal

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.graph_moves import pose_at
from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.kernels.mesh_blend import MeshBlender, PoseSet, blend_linear
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation, Provenance
from reperform.nodes.products.pose_walk import PoseWalk

_WHO = "synthesis.play_walk"


@node(over="dataset", memory=1.0)
def play_walk(
    walk: PoseWalk,
    meshes: Dataset[MeshSequence],
    *,
    blend: Annotated[
        Literal["nonlinear", "linear"], Param(about="by rotation and stretch of faces, or by vertices")
    ] = "nonlinear",
) -> Animation:
    """Play a walk: captured frames placed on the ground, and blends of two warped takes during transitions.

        x_a = placement_a(take_a at time_a), x_b alike;   x = G(x_a, x_b, weight_b)

    Moments between captured frames are linear between them. A frame of one source is the captured one, moved as a
    whole. The provenance names the nearest captured frames, so that texture can follow.

    Raises ValueError where a take of the walk is missing or takes differ in topology.

    Source: Boukhayma and Boyer 2015, 3DV (002 section 5, eqs 9-13). Departure: rotations apply from the left of column
    edges and are taken between both poses (as printed the target is missed), so one solve is exact at both ends.
    """
    takes = [str(take) for take in np.asarray(walk.takes)]
    used = [takes[k] for k in np.unique(np.asarray(walk.take))]
    missing = [take for take in used if take not in meshes]
    if missing:
        raise ValueError(f"{_WHO}: the walk plays {missing[0]!r}; the meshes have {', '.join(meshes)}")
    faces = np.asarray(meshes[used[0]].faces)
    for take in used:
        if not np.array_equal(np.asarray(meshes[take].faces), faces):
            raise ValueError(
                f"{_WHO}: takes must share one topology; {take} differs from {used[0]}: align them first"
            )
    captured = {k: np.asarray(meshes[take].vertices) for k, take in enumerate(takes) if take in used}
    frames = _Frames(walk, captured)
    out = np.empty((len(frames.weight), *next(iter(captured.values())).shape[1:]), np.float32)
    blended = np.asarray((frames.weight > 0).all(axis=1))
    for f in np.flatnonzero(~blended).tolist():
        out[f] = frames.at(f, int(frames.weight[f].argmax()))
    blender = MeshBlender.build(captured[int(walk.take[0, 0])][0], faces) if blend == "nonlinear" else None
    for run in _runs(blended):
        for f, mesh in _blend(blender, frames, run):
            out[f] = mesh
    return Animation(MeshSequence(out, faces, np.asarray(walk.fps)), _provenance(walk))


class _Frames:
    """The captured moments that a walk shows, where it shows them."""

    def __init__(self, walk: PoseWalk, captured: dict[int, np.ndarray]) -> None:
        self.captured, self.take, self.time = captured, np.asarray(walk.take), np.asarray(walk.time)
        self.weight, self.yaw, self.offset = (
            np.asarray(walk.weight),
            np.asarray(walk.yaw),
            np.asarray(walk.offset),
        )

    def at(self, f: int, side: int) -> np.ndarray:
        """Source `side` of frame f, (V, 3)."""
        pose = pose_at(self.captured[int(self.take[f, side])], self.time[f, side : side + 1])[0]
        return apply(pose.astype(np.float32), Placement(float(self.yaw[f, side]), self.offset[f, side]))


def _runs(blended: np.ndarray) -> list[np.ndarray]:
    """The frames of each transition, in order."""
    frames = np.flatnonzero(blended)
    return np.split(frames, np.flatnonzero(np.diff(frames) > 1) + 1) if len(frames) else []


def _blend(blender: MeshBlender | None, frames: _Frames, run: np.ndarray) -> Iterator[tuple[int, np.ndarray]]:
    """One transition, from its middle to both its ends, so that rotations keep their branch."""
    middle = int(run[len(run) // 2])
    for part in (run[len(run) // 2 :], run[: len(run) // 2][::-1]):
        near: PoseSet | None = None
        for f in part.tolist():
            first, second = frames.at(f, 0), frames.at(f, 1)
            if blender is None:
                yield f, blend_linear([first, second], frames.weight[f])
                continue
            if near is None and f != middle:
                near = blender.pair(frames.at(middle, 0), frames.at(middle, 1))
            near = blender.pair(first, second, near)
            yield f, blender.at(near, float(frames.weight[f, 1]))


def _provenance(walk: PoseWalk) -> Provenance:
    return Provenance(
        np.asarray(walk.takes),
        np.asarray(walk.take),
        np.rint(np.asarray(walk.time)).astype(np.int32),
        np.asarray(walk.weight, np.float32),
        np.asarray(walk.yaw),
        np.asarray(walk.offset),
    )
