"""Graphs of poses: what the best paths cost, and the edges they are made of."""

from __future__ import annotations

from typing import Any

import numpy as np

from reperform.nodes.products.essential import PoseGraph, PoseTransitions
from reperform.viewer.palette import ACCENT, INK, PAPER, RULE, SOFT_INK
from reperform.viewer.pictures.canvas import figure, pixels
from reperform.viewer.pictures.look import Look
from reperform.viewer.pictures.matrix import COLOURS


def pose_graph_picture(product: PoseGraph, frame: int, look: Look) -> np.ndarray:
    """Two matrices over all poses, from row to column: the cost of the best path, and the edges of the graph.

    Edges that blend are dots, dark where they are cheap; captured frames played on are the coloured diagonals.
    """
    with figure(look.size, "compressed") as fig:
        wide = look.size[0] >= 1.25 * look.size[1]
        left, right = fig.subplots(1, 2) if wide else fig.subplots(2, 1)
        cost = np.asarray(product.distance)
        drawn = left.imshow(np.where(np.isfinite(cost), cost, np.nan), cmap=COLOURS, vmin=0)
        fig.colorbar(drawn, ax=left, shrink=0.7, pad=0.02, label="cost of the best path")
        left.set_title("best paths", loc="left")
        _takes(left, product, PAPER)
        _draw_edges(fig, right, product, len(cost))
        _takes(right, product, RULE)
        return pixels(fig)


def pose_transitions_picture(product: PoseTransitions, frame: int, look: Look) -> np.ndarray:
    """Cost and duration of the best transition from every frame of one take (rows) to every frame of another."""
    a, b = look.pair or ("first take", "second take")
    cost = np.asarray(product.deformation) + float(product.alpha) * np.asarray(product.duration)
    with figure(look.size, "compressed") as fig:
        wide = look.size[0] >= 1.25 * look.size[1]
        axes = fig.subplots(1, 2) if wide else fig.subplots(2, 1)
        for axis, matrix, title in zip(
            axes, (cost, np.asarray(product.duration)), ("cost E", "frames from i to j"), strict=True
        ):
            drawn = axis.imshow(matrix, cmap=COLOURS, interpolation="nearest")
            axis.set(xlabel=f"to frame j of {b}", ylabel=f"from frame i of {a}")
            axis.set_title(title, loc="left")
            axis.spines[:].set_visible(False)
            fig.colorbar(drawn, ax=axis, shrink=0.7, pad=0.02)
        return pixels(fig)


def _draw_edges(fig: Any, axis: Any, product: PoseGraph, poses: int) -> None:
    source, target = np.asarray(product.source), np.asarray(product.target)
    blended = np.asarray(product.source_length) > 0
    # dots as wide as a cell of the matrix is in print
    size = min(14.0, max(0.8, 230.0 / max(poses, 1)) ** 2)
    # played frames are few and lie in lines: they stay seen among many dots
    axis.scatter(
        target[~blended], source[~blended], s=max(size, 3.0), marker="s", color=ACCENT, linewidths=0, zorder=3
    )
    dots = axis.scatter(
        target[blended], source[blended], s=size, c=np.asarray(product.cost)[blended], cmap=COLOURS, vmin=0,
        linewidths=0,
    )  # fmt: skip
    axis.set(xlim=(-0.5, poses - 0.5), ylim=(poses - 0.5, -0.5), aspect="equal")
    share = 100 * len(source) / max(poses * (poses - 1), 1)
    axis.set_title(f"{len(source)} edges, {share:.2g} % of all; alpha {float(product.alpha):g}", loc="left")
    if blended.any():
        fig.colorbar(dots, ax=axis, shrink=0.7, pad=0.02, label="cost of the transition")


def _takes(axis: Any, product: PoseGraph, line: str) -> None:
    """Lines between takes, and their names where they fit."""
    takes, frames = np.asarray(product.takes).tolist(), np.asarray(product.frames)
    ends = np.cumsum(frames)
    for end in ends[:-1]:
        axis.axhline(end - 0.5, color=line, linewidth=0.8, zorder=0.5)
        axis.axvline(end - 0.5, color=line, linewidth=0.8, zorder=0.5)
    names = [take.replace("_", " ") for take in takes] if len(takes) <= 12 else [""] * len(takes)
    axis.set_xticks(ends - frames / 2, names, rotation=90 if len(takes) > 4 else 0)
    axis.set_yticks(ends - frames / 2, names)
    axis.tick_params(length=0, labelsize=8)
    axis.set_xlabel("to", color=SOFT_INK)
    axis.set_ylabel("from", color=INK)
