"""Any number of takes blended at one weight each."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np

from reperform.nodes.blend.corresponding_poses import chosen_takes, corresponding_poses
from reperform.nodes.blend.pair_frames import Pace
from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.hybrid_build import nonlinear_blends
from reperform.nodes.kernels.mesh_blend import blend_linear
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence


@node(over="dataset", memory=2.0)
def mixture(
    meshes: Dataset[MeshSequence],
    *,
    takes: Annotated[tuple[str, ...], Param("", about="the takes to blend, in order; none: all")] = (),
    weights: Annotated[tuple[float, ...], Param("1", 0.0, 1.0, "of these takes; none: equal ones")] = (),
    method: Annotated[
        Literal["nonlinear", "linear"], Param(about="by rotation and stretch of faces, or by vertices")
    ] = "nonlinear",
    pace: Annotated[Pace, Param(about="how frames of the takes correspond")] = "stretched",
    place: Annotated[bool, Param(about="lay the other takes on the first on the ground")] = True,
) -> MeshSequence:
    """N takes blended pose by corresponding pose at weights whose sum is 1, m.

        R(w): sum_i w_i log(R(w)^T R_i) = 0,   S(w) = sum_i w_i S_i,   F(w) = R(w) S(w) per face

    then the vertices whose edges come closest to F(w) e_reference. The mean rotation does not depend on the
    order of the takes, and takes of weight 0 have no say. A weight of 1 returns that take within 1e-6 m.

    Raises ValueError where takes differ in topology or frame rate, or weights are not one per take, not
    negative, of sum 1.

    Source: Casas, Tejera, Guillemaut and Hilton 2013, IEEE TVCG (001 eqs 1-2). Departure: one mean of all
    rotations (Moakher 2002, SIAM Journal on Matrix Analysis) in place of blending pair after pair, whose
    result depends on the order.
    """
    blended = chosen_takes(meshes, takes, "blend.mixture")
    given = np.asarray(weights or (1.0 / len(blended),) * len(blended), np.float64)
    if given.shape != (len(blended),) or (given < 0.0).any() or abs(given.sum() - 1.0) > 1e-6:
        raise ValueError(
            f"blend.mixture: one weight per take ({', '.join(blended)}) needed, >= 0 with sum 1, got {tuple(weights)}"
        )
    poses = corresponding_poses(blended, pace, place, "blend.mixture")
    first = next(iter(blended.values()))
    faces = np.asarray(first.faces)
    if method == "linear":
        vertices = np.stack([blend_linear(list(poses[:, k]), given) for k in range(poses.shape[1])])
    else:
        vertices = nonlinear_blends(poses, faces)(given)
    return MeshSequence(vertices.astype(np.float32), faces, np.asarray(first.fps))
