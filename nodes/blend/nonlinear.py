"""Two takes blended by the rotation and stretch of their faces."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.blend.pair_frames import Pace, corresponding_frames
from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.mesh_blend import MeshBlender
from reperform.nodes.product import Pair
from reperform.nodes.products.mesh import MeshSequence


@node(over="pair")
def nonlinear(
    meshes: Pair[MeshSequence],
    *,
    weight: Annotated[float, Param("1", 0.0, 1.0, "weight of the second take")] = 0.5,
    pace: Annotated[Pace, Param(about="how frames of the two takes correspond")] = "stretched",
    place: Annotated[bool, Param(about="lay the second take on the first on the ground")] = True,
) -> MeshSequence:
    """Two takes blended frame by corresponding frame so that limbs turn instead of shrinking, m.

        per face, from the first take's first frame: F_a = R_a S_a, F_b = R_b S_b (polar)
        F(w) = R_a exp(w log(R_a^T R_b)) ((1 - w) S_a + w S_b)
        x(w) = argmin sum over faces and their edges of c |x_i - x_j - F(w) e_ij|^2

    Cotangent weights c are those of the first take's first frame, so that the operator is factored once. The
    branch of the logarithm is coherent between neighbouring faces, so that turns beyond half a turn stay
    whole. Weights 0 and 1 return the takes (the second as placed) within 1e-6 m; the centroid is that of the
    linear blend.

    Raises ValueError where the takes differ in topology or frame rate.

    Source: Casas, Tejera, Guillemaut and Hilton 2013, IEEE TVCG (001 eqs 1-2; 004 section 3.2).
    Departure: gradient-domain edges in place of Laplacian coordinates (Sumner and Popovic 2004, SIGGRAPH),
    with fixed weights; coherent branch of the logarithm.
    """
    blender = MeshBlender.build(meshes[0].vertices[0], meshes[0].faces)
    frames = [
        blender.at(blender.pair(first, second), weight)
        for first, second in corresponding_frames(*meshes, weight, pace, place, "blend.nonlinear")
    ]
    return MeshSequence(np.stack(frames), meshes[0].faces, meshes[0].fps)
