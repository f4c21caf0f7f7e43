"""How tall a performer stands."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence, Surfaces
from reperform.nodes.texture.parameters import one_mesh


@node(over="frame")
def height(mesh: MeshSequence | None = None, surfaces: Surfaces | None = None) -> Measures:
    """The vertical extent of a surface, m: max y - min y over its vertices. Entry `height`.

    Raises ValueError unless exactly one of `mesh` and `surfaces` is wired.
    Source: definition.
    """
    body = one_mesh("evaluate.height", mesh, surfaces)
    level = np.asarray(body.vertices, np.float64)[:, 1]
    return Measures(np.array([level.max() - level.min()]), np.array(["height"]), np.array(["m"]))
