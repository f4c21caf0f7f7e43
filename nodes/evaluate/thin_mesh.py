"""Fewer frames of a mesh sequence."""

from __future__ import annotations

from typing import Annotated

from reperform.nodes.declaration import Param, node
from reperform.nodes.evaluate.thinning import refuse_late_start
from reperform.nodes.products.mesh import MeshSequence


@node(over="take")
def thin_mesh(
    mesh: MeshSequence,
    *,
    every: Annotated[int, Param("frame", 1, None, "one frame of so many is kept")] = 8,
    first: Annotated[int, Param("frame", 0, None, "the first that is kept")] = 0,
) -> MeshSequence:
    """Some frames of a mesh sequence, for what is too costly to measure on all.

    Frames first, first + every, ... of the take with vertices (frame, vertex, 3) m; the frame rate is divided by `every`.

    Raises ValueError where the take has no frame `first`.
    Source: definition.
    """
    refuse_late_start("evaluate.thin_mesh", first, len(mesh.vertices))
    return MeshSequence(mesh.vertices[first::every], mesh.faces, mesh.fps / every)
