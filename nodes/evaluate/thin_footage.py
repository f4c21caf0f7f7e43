"""Fewer frames of footage."""

from __future__ import annotations

from typing import Annotated

from reperform.nodes.declaration import Param, node
from reperform.nodes.evaluate.thinning import refuse_late_start
from reperform.nodes.products.footage import Footage


@node(over="take", memory=2.0)
def thin_footage(
    footage: Footage,
    *,
    every: Annotated[int, Param("frame", 1, None, "one frame of so many is kept")] = 8,
    first: Annotated[int, Param("frame", 0, None, "the first that is kept")] = 0,
) -> Footage:
    """Some frames of footage, for what is too costly to measure on all.

    Frames first, first + every, ... of the take with images (frame, camera, y, x, 3); the frame rate is divided by `every`.

    Raises ValueError where the take has no frame `first`.
    Source: definition.
    """
    refuse_late_start("evaluate.thin_footage", first, len(footage.images))
    return Footage(footage.images[first::every], footage.fps / every)
