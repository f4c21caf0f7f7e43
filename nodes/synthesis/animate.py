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
    captured = {take: np.asarray(meshes[take].vertices) for take in used}
    take, frame, weight = (np.asarray(column) for column in (origin.take, origin.source_frame, origin.weight))
    yaw, offset = np.asarray(origin.yaw), np.asarray(origin.offset)
    out = np.empty((len(take), *captured[used[0]].shape[1:]), np.float32)
    for f in range(len(take)):
        placed = [
            apply(
                captured[takes[take[f, side]]][frame[f, side]],
                Placement(float(yaw[f, side]), offset[f, side]),
            )
            for side in range(2)
            if weight[f, side] > 0
        ]
        if len(placed) == 1:
            out[f] = placed[0]
        elif blender is None:
            out[f] = blend_linear(placed, weight[f])
        else:
            out[f] = blender.at(blender.pair(*placed), float(weight[f, 1]))
    return Animation(MeshSequence(out, faces, np.asarray(path.fps)), origin)
