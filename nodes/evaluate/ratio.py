"""One measurement over another."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.products.measures import Measures


@node(over="frame")
def ratio(measures: Measures, reference: Measures) -> Measures:
    """measured / reference, frame by frame and entry by entry; nan where the reference is 0 or unmeasured.

    Raises ValueError where entries or units differ.
    Source: definition.
    """
    for ours, theirs, what in (
        (measures.name, reference.name, "entries"),
        (measures.unit, reference.unit, "units"),
    ):
        if not np.array_equal(ours, theirs):
            raise ValueError(
                f"evaluate.ratio: both inputs must have the same {what}, got {', '.join(map(str, ours))} and "
                f"{', '.join(map(str, theirs))}: measure the same quantity"
            )
    below = np.where(reference.value == 0, np.nan, reference.value)
    return Measures(measures.value / below, measures.name, np.full(len(measures.name), "1"))
