"""How much space a surface encloses."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.mesh_geometry import volume as enclosed
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence, Surfaces
from reperform.nodes.texture.parameters import one_mesh


@node(over="frame")
def volume(mesh: MeshSequence | None = None, surfaces: Surfaces | None = None) -> Measures:
    """The volume inside a closed surface, m^3: sum over its faces of a . (b x c) / 6.

    vertices (V, 3) m, faces (F, 3) counter-clockwise from outside. Entry `volume`.

    Raises ValueError unless exactly one of `mesh` and `surfaces` is wired.
    Source: the divergence theorem.
    """
    body = one_mesh("evaluate.volume", mesh, surfaces)
    value = enclosed(np.asarray(body.vertices), np.asarray(body.faces))
    return Measures(np.array([float(value)]), np.array(["volume"]), np.array(["m^3"]))
