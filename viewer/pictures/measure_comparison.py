"""Several measures of dissimilarity side by side, with the transitions that each would choose."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from reperform.nodes.products.measure_comparison import MeasureComparison
from reperform.viewer.palette import ACCENT, PAPER
from reperform.viewer.pictures.canvas import figure, pixels
from reperform.viewer.pictures.look import Look
from reperform.viewer.pictures.matrix import COLOURS


def measure_comparison_picture(product: MeasureComparison, frame: int, look: Look) -> np.ndarray:
    """One matrix per measure, take after take, each on its own scale; dots are transitions."""
    names = np.asarray(product.measures).tolist()
    columns = math.ceil(math.sqrt(len(names)))
    rows = math.ceil(len(names) / columns)
    with figure(look.size, "compressed") as fig:
        axes = fig.subplots(rows, columns, squeeze=False)
        for k, axis in enumerate(axes.ravel()):
            axis.set_axis_off() if k >= len(names) else _draw(axis, product, k, k + columns >= len(names))
        if look.title:
            fig.suptitle(look.title)
        return pixels(fig)


def _draw(axis: Any, product: MeasureComparison, measure: int, last: bool) -> None:
    takes, frames = np.asarray(product.takes).tolist(), np.asarray(product.frames)
    start = np.cumsum([0, *frames[:-1]])
    axis.imshow(
        np.asarray(product.distance)[measure],
        cmap=COLOURS,
        interpolation="antialiased",
        vmin=0,
        aspect="equal",
    )
    for edge in start[1:]:
        axis.axhline(edge - 0.5, color=PAPER, linewidth=1.0)
        axis.axvline(edge - 0.5, color=PAPER, linewidth=1.0)
    chosen = np.asarray(product.measure) == measure
    y = start[np.asarray(product.source)[chosen]] + np.asarray(product.source_frame)[chosen]
    x = start[np.asarray(product.target)[chosen]] + np.asarray(product.target_frame)[chosen]
    axis.plot(
        x, y, linestyle="none", marker="o", markersize=4.5, markerfacecolor=ACCENT, markeredgecolor=PAPER,
        markeredgewidth=0.8,
    )  # fmt: skip
    axis.set_xticks(start + frames / 2, takes if last else [""] * len(takes), rotation=25)
    axis.set_yticks(start + frames / 2, takes)
    axis.tick_params(length=0, labelsize=8)
    axis.spines[:].set_visible(False)
    axis.set_title(str(np.asarray(product.measures)[measure]))
