"""One figure of a table."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.figure_target import holds, in_unit
from reperform.nodes.product import Dataset
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.table import Table

Statistic = Literal["mean", "median", "min", "max", "p99", "sum", "count"]


@node(over="dataset")
def figure(
    measures: Dataset[Measures],
    peer: Dataset[Measures] | None = None,
    *,
    figure: Annotated[str, Param("", about="name of the figure")],
    statistic: Annotated[Statistic, Param("", about="over all frames, takes and chosen entries")] = "mean",
    entry: Annotated[str, Param("", about="the entry that counts; empty: all")] = "",
    unit: Annotated[str, Param("", about="to state the figure in; empty: as measured")] = "",
    side: Annotated[Literal["<=", ">=", ""], Param("", about="of the target; empty: stated only")] = "",
    target: Annotated[float | None, Param("", about="in the figure's unit")] = None,
    peer_name: Annotated[str, Param("", about="who was measured beside it")] = "",
    source: Annotated[str, Param("", about="where the target comes from, or how it is measured")] = "",
) -> Table:
    """One row: a statistic over all frames and takes of what was measured, against its target.

    measures: value (frame, entry) of every take; unmeasured frames (nan) do not count, and where nothing was
    measured the value is nan and `holds` is -1. `count` is the number of frames measured. With `peer`, the same
    statistic of the peer's measurements stands beside it.

    Raises ValueError where no take has the entry, units differ or cannot be converted, or a side has no target.
    Source: definition.
    """
    if (side == "") != (target is None):
        raise ValueError(
            f"evaluate.figure: figure {figure!r} needs both side and target, or neither, got {side!r} and {target}"
        )
    value, shown = _statistic(measures, statistic, entry, unit)
    beside = np.nan if peer is None else _statistic(peer, statistic, entry, unit)[0]
    goal = np.nan if target is None else target
    return Table(
        np.array([figure]), np.array([value]), np.array([shown]), np.array([side]), np.array([goal]),
        np.array([holds(value, side, goal)], np.int8), np.array([peer_name]), np.array([beside]), np.array([source]),
    )  # fmt: skip


def _statistic(measures: Dataset[Measures], statistic: Statistic, entry: str, unit: str) -> tuple[float, str]:
    """The statistic of the chosen entries of all takes, and its unit."""
    values, units, known = [], set(), set()
    for taken in measures.values():
        names = np.asarray(taken.name)
        known |= set(map(str, names))
        chosen = np.flatnonzero(names == entry) if entry else np.arange(len(names))
        rows = np.asarray(taken.value)[:, chosen]
        values.append(
            rows[np.isfinite(rows).all(axis=1)] if statistic == "count" else rows[np.isfinite(rows)]
        )
        units |= {str(taken_unit) for taken_unit in np.asarray(taken.unit)[chosen]}
    if entry and entry not in known:
        raise ValueError(f"evaluate.figure: no entry {entry!r}; measured were {', '.join(sorted(known))}")
    if statistic == "count":
        return float(sum(map(len, values))), "frame"
    if len(units) > 1:
        raise ValueError(
            f"evaluate.figure: entries in {', '.join(sorted(units))} cannot make one figure: choose one entry"
        )
    measured = np.concatenate([rows.ravel() for rows in values]) if values else np.zeros(0)
    given = next(iter(units), "1")
    value = _reduced(measured, statistic) if measured.size else np.nan
    return in_unit(value, given, unit or given), unit or given


def _reduced(values: np.ndarray, statistic: Statistic) -> float:
    if statistic == "p99":
        return float(np.percentile(values, 99))
    return float(getattr(np, statistic)(values))
