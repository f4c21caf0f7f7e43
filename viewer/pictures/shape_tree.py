"""Shape similarity trees: frames around their root, coloured by take."""

from __future__ import annotations

import numpy as np

from reperform.nodes.products.motion import ShapeTree
from reperform.viewer.palette import ACCENT, INK, SOFT_INK
from reperform.viewer.pictures.canvas import figure, pixels
from reperform.viewer.pictures.look import Look
from reperform.viewer.pictures.motion_graph import take_colour


def shape_tree_picture(product: ShapeTree, frame: int, look: Look) -> np.ndarray:
    """The tree drawn outwards from its root; branches from one take to another are red."""
    parent, take = np.asarray(product.parent), np.asarray(product.take)
    order = np.asarray(product.order)
    depth, angle = radial_places(parent, order)
    x, y = depth * np.cos(angle), depth * np.sin(angle)
    takes = np.asarray(product.takes).tolist()
    with figure(look.size) as fig:
        axis = fig.subplots()
        for k in range(len(parent)):
            p = int(parent[k])
            if p == k:
                continue
            crosses = take[p] != take[k]
            # A branch bends at its parent's circle, so that branches of one depth do not cross.
            t = np.linspace(0, 1, 12)
            turn = angle[p] + (angle[k] - angle[p]) * np.minimum(2 * t, 1)
            reach = depth[p] + (depth[k] - depth[p]) * t
            axis.plot(
                reach * np.cos(turn),
                reach * np.sin(turn),
                color=ACCENT if crosses else take_colour(int(take[k])),
                linewidth=1.5 if crosses else 0.7,
                alpha=1.0 if crosses else 0.55,
                zorder=2 if crosses else 1,
            )
        size = float(np.clip(900 / max(len(parent), 1), 2.0, 36.0))
        for k, name in enumerate(takes):
            own = take == k
            axis.scatter(
                x[own], y[own], s=size, color=take_colour(k), label=f"{name} ({own.sum()})", zorder=3
            )
        root = int(order[0])
        axis.scatter(x[root], y[root], s=90, facecolor="none", edgecolor=INK, linewidth=1.6, zorder=4)
        axis.annotate(
            f"root: {takes[take[root]]} {int(np.asarray(product.frame_index)[root])}",
            (x[root], y[root]),
            xytext=(8, 8),
            textcoords="offset points",
            fontsize=8.5,
        )
        crossing = int((take != take[parent]).sum())
        axis.set_title(
            f"{len(parent)} frames, depth {int(depth.max(initial=0))}, {crossing} branches between takes, "
            f"largest step {float(np.max(product.distance, initial=0)):.3g}",
            color=SOFT_INK,
            fontsize=10,
        )
        axis.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8.5)
        axis.set_aspect("equal")
        axis.axis("off")
        return pixels(fig)


def radial_places(parent: np.ndarray, order: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Depth and angle of every node: each branch gets a share of the circle by its number of leaves."""
    count = len(parent)
    leaves, depth = np.zeros(count), np.zeros(count)
    has_child = np.zeros(count, bool)
    has_child[parent[parent != np.arange(count)]] = True
    leaves[~has_child] = 1
    for k in order[::-1]:
        if parent[k] != k:
            leaves[parent[k]] += leaves[k]
    start, angle = np.zeros(count), np.zeros(count)
    used = np.zeros(count)
    total = max(leaves[order[0]], 1.0) if count else 1.0
    for k in order:
        p = parent[k]
        if p != k:
            depth[k] = depth[p] + 1
            start[k] = start[p] + used[p]
            used[p] += leaves[k]
        angle[k] = 2 * np.pi * (start[k] + leaves[k] / 2) / total
    return depth, angle
