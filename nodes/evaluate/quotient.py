"""The mean of one entry over the mean of another."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.products.measures import Measures


@node(over="take")
def quotient(
    measures: Measures,
    *,
    over: Annotated[str, Param("", about="the entry above the line")],
    under: Annotated[str, Param("", about="the entry below the line")],
) -> Measures:
    """mean(over) / mean(under) over the rows in which both were measured; nan where there are none.

    Raises ValueError where an entry is missing or units differ.
    Source: definition.
    """
    names = [str(name) for name in np.asarray(measures.name)]
    for entry in (over, under):
        if entry not in names:
            raise ValueError(
                f"evaluate.quotient: no entry {entry!r}; measured were {', '.join(sorted(names))}"
            )
    above, below = names.index(over), names.index(under)
    units = np.asarray(measures.unit)
    if units[above] != units[below]:
        raise ValueError(
            f"evaluate.quotient: both entries must have one unit, got {units[above]} and {units[below]}"
        )
    rows = np.asarray(measures.value)[:, [above, below]]
    rows = rows[np.isfinite(rows).all(axis=1)]
    mean = rows.mean(axis=0) if len(rows) else np.full(2, np.nan)
    value = mean[0] / mean[1] if mean[1] != 0 else np.nan
    return Measures(np.array([[value]]), np.array([f"{over} over {under}"]), np.array(["1"]))
