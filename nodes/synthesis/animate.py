"""The mesh sequence of a path."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.kernels.mesh_blend import MeshBlender, blend_linear
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation, MotionPath


@node(over="dataset", memory=1.0)
def animate(
    path: MotionPath,
    meshes: Dataset[MeshSequence],
    *,
    blend: Annotated[
        Literal["nonlinear", "linear"], Param(about="by rotation and stretch of faces, or by vertices")
    ] = "nonlinear",
) -> Animation:
    """Play a path: captured frames placed on the ground, and blends of two of them during transitions.

        x_world = R_y(yaw) x_captured + (offset_x, 0, offset_z), per source; then G(x_a, x_b, weight)

    A frame of one source is the captured one, moved as a whole. Weights are flat at both ends of a
    transition, so that velocity is continuous. The provenance comes along, so that texture can follow.

    Raises ValueError where a take of the path is missing or takes differ in topology.

    Source: Huang, Tejera, Collomosse and Hilton 2015, ACM TOG (000 eq 6, section 4.4); placement along the
    path: Kovar, Gleicher and Pighin 2002, SIGGRAPH.
    """
    origin = path.provenance
    takes = [str(take) for take in np.asarray(origin.takes)]
    used = sorted({takes[k] for k in np.unique(np.asarray(origin.take))})
    missing = [take for take in used if take not in meshes]
    if missing:
        raise ValueError(
            f"synthesis.animate: the path plays {missing[0]!r}; the meshes have {', '.join(meshes)}"
        )
    faces = np.asarray(meshes[used[0]].faces)
    for take in used:
        if not np.array_equal(np.asarray(meshes[take].faces), faces):
            raise ValueError(
                f"synthesis.animate: takes must share one topology; {take} differs from {used[0]}: "
                f"align them first"
            )
    blender = None
    if blend == "nonlinear":
        blender = MeshBlender.build(np.asarray(meshes[used[0]].vertices[0]), faces)
    places = _Places(path, {take: np.asarray(meshes[take].vertices) for take in used})
    weight = np.asarray(origin.weight)
    blended = np.asarray((weight > 0).all(axis=1))
    out = np.empty((len(weight), *places.shape), np.float32)
    for f in np.flatnonzero(~blended).tolist():
        out[f] = places.at(f, int(np.argmax(weight[f])))
    for run in _runs(blended):
        if blender is None:
            for f in run:
                out[f] = blend_linear([places.at(f, 0), places.at(f, 1)], weight[f])
        else:
            _blend_run(blender, places, weight, run, out)
    return Animation(MeshSequence(out, faces, np.asarray(path.fps)), origin)


class _Places:
    """The captured frames that a path shows, where it shows them."""

    def __init__(self, path: MotionPath, captured: dict[str, np.ndarray]) -> None:
        origin = path.provenance
        takes = [str(take) for take in np.asarray(origin.takes)]
        self.captured = [captured.get(take) for take in takes]
        self.take, self.frame = np.asarray(origin.take), np.asarray(origin.source_frame)
        self.yaw, self.offset = np.asarray(origin.yaw), np.asarray(origin.offset)
        self.shape = next(iter(captured.values())).shape[1:]

    def at(self, f: int, side: int) -> np.ndarray:
        """Source `side` of frame f, placed on the ground, (V, 3)."""
        vertices = self.captured[self.take[f, side]]
        placement = Placement(float(self.yaw[f, side]), self.offset[f, side])
        return apply(np.asarray(vertices)[self.frame[f, side]], placement)


def _runs(blended: np.ndarray) -> list[np.ndarray]:
    """The frames of each transition, in order."""
    frames = np.flatnonzero(blended)
    return np.split(frames, np.flatnonzero(np.diff(frames) > 1) + 1) if len(frames) else []


def _blend_run(
    blender: MeshBlender, places: _Places, weight: np.ndarray, run: np.ndarray, out: np.ndarray
) -> None:
    """Blend one transition from its middle, where both takes are most alike, to both its ends."""
    middle = len(run) // 2
    for part in (run[middle:], run[:middle][::-1]):
        near = blender.pair(places.at(run[middle], 0), places.at(run[middle], 1))
        for f in part:
            near = blender.pair(places.at(f, 0), places.at(f, 1), near)
            out[f] = blender.at(near, float(weight[f, 1]))
