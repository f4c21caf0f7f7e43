"""Fewer frames of surfaces."""

from __future__ import annotations

from typing import Annotated

from reperform.nodes.declaration import Param, node
from reperform.nodes.evaluate.thinning import refuse_late_start
from reperform.nodes.products.mesh import Surfaces


@node(over="take")
def thin_surfaces(
    surfaces: Surfaces,
    *,
    every: Annotated[int, Param("frame", 1, None, "one frame of so many is kept")] = 8,
    first: Annotated[int, Param("frame", 0, None, "the first that is kept")] = 0,
) -> Surfaces:
    """Some frames of surfaces, for what is too costly to measure on all.

    Frames first, first + every, ... of the take with vertices (vertex, 3) m and faces of their own; the frame
    rate is divided by `every`.

    Raises ValueError where the take has no frame `first`.
    Source: definition.
    """
    refuse_late_start("evaluate.thin_surfaces", first, len(surfaces.vertices))
    return Surfaces(surfaces.vertices[first::every], surfaces.faces[first::every], surfaces.fps / every)
