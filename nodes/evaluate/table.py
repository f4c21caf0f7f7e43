"""Figures side by side."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.product import Dataset
from reperform.nodes.products.table import Table


@node(over="dataset")
def table(figures: Dataset[Table]) -> Table:
    """All rows of several tables in one, in the order in which they are wired.

    Raises ValueError where two rows have one name.
    Source: definition.
    """
    tables = list(figures.values())
    names = [str(name) for rows in tables for name in np.asarray(rows.figure)]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ValueError(
            f"evaluate.table: every figure needs a name of its own, got {', '.join(twice)} twice"
        )
    return Table(
        *(np.concatenate([np.asarray(getattr(rows, field)) for rows in tables]) for field in Table._fields)
    )
