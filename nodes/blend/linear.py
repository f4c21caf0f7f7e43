"""Two takes blended by their vertices."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.blend.pair_frames import Pace, corresponding_frames
from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.mesh_blend import blend_linear
from reperform.nodes.product import Pair
from reperform.nodes.products.mesh import MeshSequence


@node(over="pair")
def linear(
    meshes: Pair[MeshSequence],
    *,
    weight: Annotated[float, Param("1", 0.0, 1.0, "weight of the second take")] = 0.5,
    pace: Annotated[Pace, Param(about="how frames of the two takes correspond")] = "stretched",
    place: Annotated[bool, Param(about="lay the second take on the first on the ground")] = True,
) -> MeshSequence:
    """The weighted mean of the vertices of two takes, frame by corresponding frame, m.

        x(w) = (1 - w) x_a + w x_b

    Weights 0 and 1 return the takes to the bit (the second as placed). What turns far between the takes
    shrinks.

    Raises ValueError where the takes differ in topology or frame rate.

    Source: Casas, Tejera, Guillemaut and Hilton 2013, IEEE TVCG (001 section 3.1.2), linear vertex blending.
    """
    weights = np.array([1.0 - weight, weight])
    frames = [
        blend_linear([first, second], weights)
        for first, second in corresponding_frames(*meshes, weight, pace, place, "blend.linear")
    ]
    return MeshSequence(np.stack(frames), meshes[0].faces, meshes[0].fps)
