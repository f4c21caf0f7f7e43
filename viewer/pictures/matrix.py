"""Dissimilarity matrices with the transitions that a motion graph found in them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from reperform.nodes.products.motion import Dissimilarity, MotionGraph
from reperform.viewer.palette import ACCENT, PAPER
from reperform.viewer.pictures.canvas import figure, pixels
from reperform.viewer.pictures.look import Look

COLOURS = "viridis"


def matrix_picture(product: Dissimilarity, frame: int, look: Look) -> np.ndarray:
    """Frames of one take against frames of another; dark is alike, circles are transitions."""
    distance = np.asarray(product.distance)
    a, b = look.pair or ("first take", "second take")
    with figure(look.size, "compressed") as fig:
        axis = fig.subplots()
        drawn = axis.imshow(distance, cmap=COLOURS, interpolation="nearest", aspect="equal", vmin=0)
        axis.spines[:].set_visible(False)
        axis.set(xlabel=f"frame of {b}", ylabel=f"frame of {a}", title=look.title or f"{a} to {b}")
        if look.graph is not None and look.pair is not None:
            marked = _mark(axis, look.graph, look.pair, (0, 0), 9.0)
            axis.set_title(f"{a} to {b}: {marked} transition{'s' * (marked != 1)}")
        fig.colorbar(drawn, ax=axis, shrink=0.85, pad=0.02, label="dissimilarity")
        return pixels(fig)


def matrices_picture(products: Mapping[tuple[str, str], Dissimilarity], look: Look) -> np.ndarray:
    """All pairs of takes in one matrix, take after take, with every transition marked."""
    takes = list(dict.fromkeys(take for pair in products for take in pair))
    length = {pair[0]: int(product.distance.shape[0]) for pair, product in products.items()}
    length |= {pair[1]: int(product.distance.shape[1]) for pair, product in products.items()}
    start = dict(zip(takes, np.cumsum([0, *[length[take] for take in takes]])[:-1].tolist(), strict=True))
    total = sum(length.values())
    whole = np.full((total, total), np.nan, np.float32)
    for (a, b), product in products.items():
        whole[start[a] : start[a] + length[a], start[b] : start[b] + length[b]] = np.asarray(product.distance)
    with figure(look.size, "compressed") as fig:
        axis = fig.subplots()
        drawn = axis.imshow(whole, cmap=COLOURS, interpolation="antialiased", vmin=0)
        for take in takes[1:]:
            axis.axhline(start[take] - 0.5, color=PAPER, linewidth=1.2)
            axis.axvline(start[take] - 0.5, color=PAPER, linewidth=1.2)
        middles = [start[take] + length[take] / 2 for take in takes]
        axis.set_xticks(middles, takes, rotation=30 if len(takes) > 4 else 0)
        axis.set_yticks(middles, takes)
        axis.tick_params(length=0)
        axis.spines[:].set_visible(False)
        axis.set(ylabel="from", xlabel="to")
        if look.graph is not None:
            for pair in products:
                _mark(axis, look.graph, pair, (start[pair[0]], start[pair[1]]), 5.5)
        fig.colorbar(drawn, ax=axis, shrink=0.85, pad=0.02, label="dissimilarity")
        return pixels(fig)


def _mark(axis: Any, graph: MotionGraph, pair: tuple[str, str], corner: tuple[int, int], size: float) -> int:
    """Circle the transitions of a pair, with the diagonal run of frames that each blends."""
    takes = np.asarray(graph.takes).tolist()
    if pair[0] not in takes or pair[1] not in takes:
        return 0
    chosen = (np.asarray(graph.source) == takes.index(pair[0])) & (
        np.asarray(graph.target) == takes.index(pair[1])
    )
    rows = np.asarray(graph.source_frame)[chosen] + corner[0]
    columns = np.asarray(graph.target_frame)[chosen] + corner[1]
    for row, column, length in zip(rows, columns, np.asarray(graph.length)[chosen], strict=True):
        axis.plot(
            [column - length, column + length], [row - length, row + length], color=PAPER, linewidth=2.2
        )
        axis.plot(
            [column - length, column + length], [row - length, row + length], color=ACCENT, linewidth=1.2
        )
    style = {"linestyle": "none", "marker": "o", "markeredgecolor": PAPER, "markeredgewidth": 1.2}
    axis.plot(columns, rows, markersize=size, markerfacecolor=ACCENT, **style)
    axis.autoscale(False)
    return int(chosen.sum())
