"""Vertex dissimilarity of frames that share a topology."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.ground_plane_distance import Motion, ground_plane_distance
from reperform.nodes.kernels.one_topology import require_one_topology
from reperform.nodes.product import Pair
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity


@node(over="pair", memory=1.0)
def vertex(
    mesh: Pair[MeshSequence],
    *,
    align: Annotated[
        Motion, Param(about="ground-plane motion that does not count as a difference")
    ] = "yaw_and_offset",
) -> Dissimilarity:
    """How far the vertices of every frame of one take are from those of the other, in metres: (frame_a, frame_b).

    d(i, j) = min over a turn about the vertical and a shift on the ground of sqrt(1/N sum |X_i - X_j|^2), all
    pairs at once, in closed form.

    Raises ValueError where the takes differ in topology.

    Source: 000 section 4.2, fig 4 (Euclidean vertex distance); Kovar, Gleicher and Pighin 2002, SIGGRAPH (ground
    plane).
    """
    a, b = mesh
    require_one_topology("similarity.vertex", (a.faces, b.faces), (a.vertices.shape[1], b.vertices.shape[1]))
    distance = ground_plane_distance(a.vertices, b.vertices, a.vertices, b.vertices, 0.0, align)
    return Dissimilarity(distance.astype(np.float32))
