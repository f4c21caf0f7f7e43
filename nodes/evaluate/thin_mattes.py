"""Fewer frames of mattes."""

from __future__ import annotations

from typing import Annotated

from reperform.nodes.declaration import Param, node
from reperform.nodes.evaluate.thinning import refuse_late_start
from reperform.nodes.products.footage import Mattes


@node(over="take", memory=1.0)
def thin_mattes(
    mattes: Mattes,
    *,
    every: Annotated[int, Param("frame", 1, None, "one frame of so many is kept")] = 8,
    first: Annotated[int, Param("frame", 0, None, "the first that is kept")] = 0,
) -> Mattes:
    """Some frames of mattes, for what is too costly to measure on all.

    Frames first, first + every, ... of the take with alpha (frame, camera, y, x); the frame rate is divided by `every`.

    Raises ValueError where the take has no frame `first`.
    Source: definition.
    """
    refuse_late_start("evaluate.thin_mattes", first, len(mattes.alpha))
    return Mattes(mattes.alpha[first::every], mattes.fps / every)
