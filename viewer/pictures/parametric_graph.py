"""Parametric motion graphs: similarity matrices of an edge and a trellis across it; suggested spaces."""

from __future__ import annotations

from typing import Any

import numpy as np

from reperform.nodes.kernels.transition_search import best_transition, new_found
from reperform.nodes.kernels.transition_tables import EdgeTables
from reperform.nodes.kernels.trellis import Trellis, fill_trellis, new_trellis
from reperform.nodes.motion_graph.edge_tables import edge_tables
from reperform.nodes.products.parametric import ParametricGraph, SpaceSuggestion
from reperform.viewer.palette import ACCENT, INK, PAPER, RULE, SOFT_INK
from reperform.viewer.pictures.canvas import figure, pixels
from reperform.viewer.pictures.look import Look
from reperform.viewer.pictures.matrix import COLOURS
from reperform.viewer.pictures.motion_graph import take_colour


def parametric_graph_picture(product: ParametricGraph, frame: int, look: Look) -> np.ndarray:
    """Of the first edge: matrices of its inputs with fixed transitions, and the trellis of one transition."""
    names = np.asarray(product.spaces)
    source, target = (str(names[int(np.asarray(end)[0])]) for end in (product.source, product.target))
    tables = edge_tables(product, 0)
    with figure(look.size) as fig:
        left, right = fig.subplots(1, 2, width_ratios=(1, 1.15))
        drawn = _matrices(left, product, tables)
        left.set(xlabel=f"inputs of {target}, pose by pose", ylabel=f"inputs of {source}, pose by pose")
        left.set_title(f"{source} to {target}: dark is alike, ○ fixed transitions")
        fig.colorbar(drawn, ax=left, shrink=0.7, pad=0.02, label="dissimilarity", location="bottom")
        _trellis(right, product, tables, source, target)
        edges = len(np.asarray(product.source))
        others = f"{len(names)} spaces, {edges} edge{'s' * (edges != 1)}"
        fig.suptitle(look.title or others)
        return pixels(fig)


def _matrices(axis: Any, product: ParametricGraph, tables: EdgeTables) -> Any:
    """Inputs are the first references: as many as have controls at the corners of cells."""
    rows, columns = (int(side.cells.corners.max()) + 1 for side in (tables.source, tables.target))
    poses, others = tables.distance.shape[0], tables.distance.shape[2]
    block = tables.distance[:, :rows, :, :columns].transpose(1, 0, 3, 2)
    whole = block.reshape(rows * poses, columns * others) / tables.largest
    drawn = axis.imshow(whole, cmap=COLOURS, interpolation="nearest", vmin=0, aspect="auto")
    for k in range(1, rows):
        axis.axhline(k * poses - 0.5, color=PAPER, linewidth=1.5)
    for k in range(1, columns):
        axis.axvline(k * others - 0.5, color=PAPER, linewidth=1.5)
    mine = np.asarray(product.fixed_edge) == 0
    pose, reference = np.asarray(product.fixed_pose)[mine], np.asarray(product.fixed_reference)[mine]
    # a transition between blends is marked at the inputs nearest in control
    near = [
        np.abs(side.control[reference[:, k], None] - side.control[None, :count]).sum(axis=2).argmin(axis=1)
        for k, (side, count) in enumerate(((tables.source, rows), (tables.target, columns)))
    ]
    axis.plot(
        near[1] * others + pose[:, 1], near[0] * poses + pose[:, 0], linestyle="none", marker="o",
        markerfacecolor="none", markeredgecolor=PAPER, markersize=7,
    )  # fmt: skip
    axis.spines[:].set_visible(False)
    return drawn


def _trellis(axis: Any, product: ParametricGraph, tables: EdgeTables, source: str, target: str) -> None:
    """States before and after the transition against time, by their first control; and the way that is taken."""
    depth, step = int(np.asarray(product.depth)), float(np.asarray(product.step))
    weight, threshold = float(np.asarray(product.latency_weight)), float(np.asarray(product.threshold))
    a, b = new_trellis(tables.source, depth, step), new_trellis(tables.target, depth, step)
    start, end = (
        np.full(side.control.shape[1], u) for side, u in ((tables.source, 0.9), (tables.target, 0.65))
    )
    goal = int(0.54 * tables.target.spread.shape[0])
    found = new_found(tables, depth, step)
    able = best_transition(tables, 1, start, goal, end, depth, step, weight, threshold, found)
    fill_trellis(tables.source, 1, start, 1, depth, step, a)
    fill_trellis(tables.target, goal, end, -1, depth, step, b)
    total = float(found.cost[2] + found.cost[3]) if able else float(a.seconds.max() + b.seconds.max())
    _states(axis, a, 0.0, 1.0, take_colour(0), f"{source}: from now on")
    _states(axis, b, total, -1.0, take_colour(1), f"{target}: to the wanted state")
    axis.plot(0, start[0], "o", color=INK, markersize=8)
    axis.plot(total, end[0], "s", color=INK, markersize=8)
    if able:
        when = float(found.cost[2])
        axis.plot([0, when], [start[0], found.source_control[0]], color=ACCENT, linewidth=2)
        axis.plot([when, total], [found.target_control[0], end[0]], color=ACCENT, linewidth=2)
        axis.plot(
            [when, when],
            [found.source_control[0], found.target_control[0]],
            color=ACCENT,
            linewidth=2,
            linestyle=":",
        )
        said = (
            f"leave pose {found.source_pose[0]:.1f}, enter pose {found.target_pose[0]:.1f}: dissimilarity "
            f"{found.cost[0] / 1000:.3f}, {total:.2f} s"
        )
    else:
        said = f"refused: nothing within dissimilarity {threshold:g}"
    axis.set(xlabel="seconds", ylabel="control (0 lowest input, 1 highest)", ylim=(-0.06, 1.3))
    axis.set_title(said)
    axis.grid(color=RULE)
    axis.legend(loc="upper center", ncols=2)


def _states(axis: Any, trellis: Trellis, origin: float, sign: float, colour: str, label: str) -> None:
    count = int(trellis.size[0])
    time = origin + sign * trellis.seconds[:count]
    axis.plot(
        time, trellis.control[:count, 0], linestyle="none", marker=".", color=colour, alpha=0.55, label=label
    )


def space_suggestion_picture(product: SpaceSuggestion, frame: int, look: Look) -> np.ndarray:
    """The tree of takes, cut into spaces, beside their distances in its order."""
    from scipy.cluster.hierarchy import dendrogram

    takes, label = np.asarray(product.takes).tolist(), np.asarray(product.label)
    cut = float(np.asarray(product.cut))
    with figure(look.size) as fig:
        left, right = fig.subplots(1, 2)
        tree = dendrogram(
            np.asarray(product.joins), labels=takes, orientation="left", ax=left, color_threshold=0,
            above_threshold_color=SOFT_INK,
        )  # fmt: skip
        left.axvline(cut, color=ACCENT, linewidth=1.2, linestyle="--")
        for text in left.get_yticklabels():
            text.set_color(take_colour(int(label[takes.index(text.get_text())])))
            text.set_fontsize(9.5)
        left.spines[:].set_visible(False)
        left.set(xlabel="distance of takes", title=f"{label.max() + 1} spaces, by colour")
        order = tree["leaves"][::-1]
        drawn = right.imshow(np.asarray(product.distance)[np.ix_(order, order)], cmap=COLOURS, vmin=0)
        right.set_xticks(range(len(order)), [takes[k] for k in order], rotation=60, ha="right")
        right.set_yticks(range(len(order)), [takes[k] for k in order])
        right.tick_params(length=0)
        right.spines[:].set_visible(False)
        fig.colorbar(drawn, ax=right, shrink=0.6, pad=0.02, label="distance")
        return pixels(fig)
