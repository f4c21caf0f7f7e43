"""Vertex and velocity dissimilarity of frames that share a topology."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.ground_plane_distance import ground_plane_distance, velocity
from reperform.nodes.kernels.one_topology import require_one_rate, require_one_topology
from reperform.nodes.product import Pair
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity


@node(over="pair", memory=1.0)
def vertex_velocity(
    mesh: Pair[MeshSequence],
    *,
    velocity_weight: Annotated[
        float, Param("1", 0.0, 100.0, "weight of the difference of motion per frame against that of shape")
    ] = 1.0,
    align: Annotated[
        Literal["yaw_and_offset", "offset", "none"],
        Param(about="ground-plane motion that does not count as a difference"),
    ] = "yaw_and_offset",
) -> Dissimilarity:
    """How far every frame of one take is from every frame of the other, in metres: (frame_a, frame_b).

    d(i, j) = min over a turn about the vertical and a shift on the ground of sqrt(1/N (sum |X_i - X_j|^2 +
    velocity_weight sum |V_i - V_j|^2)), V(t) = X(t) - X(t - 1) in metres per frame (the first frame takes
    the velocity of the second). All pairs at once, in closed form.

    Raises ValueError where the takes differ in topology or frame rate.

    Source: 001 section 3.2.1 (Casas, Tejera, Guillemaut and Hilton, IEEE TVCG 2013); ground-plane motion:
    Kovar, Gleicher and Pighin, SIGGRAPH 2002.
    Departure: the root, so that the unit is the metre and the triangle inequality holds; a dissimilarity,
    since s = 1 - d / max d cannot be compared between pairs of takes; least over the ground-plane motion of
    the whole sum, since takes start anywhere in the studio.
    """
    a, b = mesh
    require_one_topology("vertex_velocity", (a.faces, b.faces), (a.vertices.shape[1], b.vertices.shape[1]))
    require_one_rate("vertex_velocity", a.fps, b.fps)
    distance = ground_plane_distance(
        a.vertices, b.vertices, velocity(a.vertices), velocity(b.vertices), velocity_weight, align
    )
    return Dissimilarity(distance.astype(np.float32))
