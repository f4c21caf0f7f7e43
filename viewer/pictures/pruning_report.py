"""What was taken out of a motion graph, and why."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from reperform.nodes.products.pruned_graph import PrunedGraph, PruningReport
from reperform.viewer.palette import SOFT_INK
from reperform.viewer.pictures.look import Look
from reperform.viewer.pictures.motion_graph import motion_graph_picture
from reperform.viewer.pictures.tabulate import Cell, draw_table, number

# Rows that a page holds legibly.
_ROWS = 40


def pruning_report_picture(product: PruningReport, frame: int, look: Look) -> np.ndarray:
    """One line for each transition and take that went; past a page how many more there are."""
    columns = (np.asarray(column).tolist() for column in product)
    rows = [
        [Cell(what), Cell(number(cost) if np.isfinite(cost) else "", right=True), Cell(why, SOFT_INK)]
        for what, cost, why in zip(*columns, strict=True)
    ]
    more = len(rows) - _ROWS
    if more > 0:
        rows = [*rows[:_ROWS], [Cell(f"and {more} more"), Cell("", right=True), Cell("")]]
    title = look.title or f"{len(np.asarray(product.what))} transitions and takes taken out"
    return draw_table(["what went", "cost", "why"], rows, look.size, title)


def pruned_graph_picture(product: PrunedGraph, frame: int, look: Look) -> np.ndarray:
    """The graph that is left, above the report of what went."""
    wide, tall = look.size
    above = motion_graph_picture(product.graph, frame, replace(look, size=(wide, tall - tall // 3)))
    return np.concatenate(
        [above, pruning_report_picture(product.report, frame, replace(look, size=(wide, tall // 3)))]
    )
