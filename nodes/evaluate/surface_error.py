"""How far a rebuilt surface is from the true one."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.surface_distance import mean_distance
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence, Surfaces
from reperform.nodes.texture.parameters import one_mesh


@node(over="frame")
def surface_error(
    truth: MeshSequence, surfaces: Surfaces | None = None, mesh: MeshSequence | None = None
) -> Measures:
    """Mean distance between a rebuilt surface and the true one, both ways, m.

    e = (d(S, T) + d(T, S)) / 2;  d(A, B) = mean over the area of A of the distance to the nearest point of B

    vertices (V, 3) m; exact point-to-triangle distances, means weighted by vertex area, so that vertex density has
    no say. Entries: `error` (e), `excess` d(S, T) and `missing` d(T, S): what is rebuilt and not there, and what is
    there and not rebuilt. It does not tell whether parts are where they belong: see `evaluate.correspondence`.

    Raises ValueError unless exactly one of `surfaces` and `mesh` is wired.
    Source: Aspert, Santa-Cruz and Ebrahimi 2002, ICME (MESH: mean symmetric distance).
    """
    built = one_mesh("evaluate.surface_error", mesh, surfaces)
    excess = mean_distance(built.vertices, built.faces, truth.vertices, truth.faces)
    missing = mean_distance(truth.vertices, truth.faces, built.vertices, built.faces)
    return Measures(
        np.array([0.5 * (excess + missing), excess, missing]),
        np.array(["error", "excess", "missing"]),
        np.full(3, "m"),
    )
