"""The worst of several figures."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.figure_target import holds
from reperform.nodes.product import Dataset
from reperform.nodes.products.table import Table


@node(over="dataset")
def worst(
    figures: Dataset[Table],
    *,
    figure: Annotated[str, Param("", about="name of the figure")],
    side: Annotated[Literal["<=", ">="], Param("", about="of the target")],
    target: Annotated[float, Param("", about="in the figures' unit")],
    source: Annotated[str, Param("", about="where the target comes from, or how it is measured")] = "",
) -> Table:
    """One row: the greatest (side <=) or least (side >=) of all rows, against its target; its source names it.

    Where any of them was not measured (nan) neither is the worst.
    Raises ValueError where the figures have different units.
    Source: definition.
    """
    values = np.concatenate([np.asarray(rows.value, np.float64) for rows in figures.values()])
    names = [str(name) for rows in figures.values() for name in np.asarray(rows.figure)]
    units = {str(unit) for rows in figures.values() for unit in np.asarray(rows.unit)}
    if len(units) != 1:
        raise ValueError(
            f"evaluate.worst: {figure!r} needs figures of one unit, got {', '.join(sorted(units)) or 'none'}"
        )
    chosen = int(np.argmax(values) if side == "<=" else np.argmin(values))
    value = float(values[chosen])
    told = f"worst of {len(values)}: {names[chosen]}"
    return Table(
        np.array([figure]), np.array([value]), np.array([units.pop()]), np.array([side]), np.array([target]),
        np.array([holds(value, side, target)], np.int8), np.array([""]), np.array([np.nan]),
        np.array([f"{source}; {told}" if source else told]),
    )  # fmt: skip
