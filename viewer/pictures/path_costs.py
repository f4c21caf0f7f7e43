"""Curves of the costs of best paths in two graphs, one panel per database."""

from __future__ import annotations

import numpy as np

from reperform.nodes.products.essential import PathCosts
from reperform.viewer.palette import ACCENT, RULE, SOFT_INK, STATIONS, tint
from reperform.viewer.pictures.canvas import figure, pixels
from reperform.viewer.pictures.look import Look


def path_costs_picture(product: PathCosts, frame: int, look: Look) -> np.ndarray:
    """Per panel, paths from the cheapest to the dearest: the motion graph's line above the essential graph's.

    Dots are the essential graph's cost of the very pair of poses that the motion graph's line is at.
    """
    names = np.asarray(product.panel).tolist()
    columns = min(len(names), 2 if len(names) <= 4 else 3)
    rows = -(-len(names) // max(columns, 1))
    with figure(look.size) as fig:
        axes = np.atleast_1d(fig.subplots(rows, columns, squeeze=False)).ravel()
        for k, (axis, name) in enumerate(zip(axes, names, strict=False)):
            cost = np.asarray(product.cost)[k]
            share = np.linspace(0, 100, len(cost))
            best = STATIONS.get("motion_graph", ACCENT)
            axis.scatter(
                share, cost[:, 1], s=2.0, color=tint(best, 0.6), linewidths=0, label="same pair of poses"
            )
            axis.plot(share, cost[:, 0], color=SOFT_INK, lw=1.6, label="motion graph")
            axis.plot(share, cost[:, 2], color=best, lw=1.6, label="essential graph")
            axis.grid(True, color=RULE, lw=0.6)
            axis.set(xlim=(0, 100), ylim=(0, None))
            axis.set_title(
                f"{name}: alpha {float(product.alpha[k]):g}, {int(product.pairs[k]):,} paths",
                loc="left",
                fontsize=9.5,
            )
            if k % columns == 0:
                axis.set_ylabel("cost of the best path")
            if k >= len(names) - columns:
                axis.set_xlabel("paths, per cent")
        for axis in axes[len(names) :]:
            axis.axis("off")
        axes[0].legend(loc="upper left", fontsize=8.5, markerscale=3)
        return pixels(fig)
