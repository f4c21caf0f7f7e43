"""Motion graphs: takes as nodes, edges with their transitions, and where in time they leave and enter."""

from __future__ import annotations

from typing import Any

import numpy as np

from reperform.nodes.products.motion import MotionGraph
from reperform.viewer.palette import ACCENT, INK, PAPER, RULE, SOFT_INK, STATIONS, tint
from reperform.viewer.pictures.canvas import figure, pixels
from reperform.viewer.pictures.look import Look

TAKE_COLOURS = [
    STATIONS[name] for name in ("capture", "similarity", "align", "synthesis", "blend", "texture")
]


def take_colour(index: int) -> str:
    """The colour of a take, the same in every picture."""
    return TAKE_COLOURS[index % len(TAKE_COLOURS)]


def motion_graph_picture(product: MotionGraph, frame: int, look: Look) -> np.ndarray:
    """The graph, edges thick where transitions are many, dark where the best is cheap; and their frames.

    Transitions outside the core, which lead into dead ends, are dashed.
    """
    takes = np.asarray(product.takes).tolist()
    with figure(look.size) as fig:
        wide = look.size[0] >= 1.25 * look.size[1]
        left, right = fig.subplots(1, 2, width_ratios=[1, 1.05]) if wide else fig.subplots(2, 1)
        _draw_graph(left, product, takes)
        _draw_times(right, product, takes)
        return pixels(fig)


def edge_counts(product: MotionGraph) -> dict[tuple[int, int], tuple[int, float]]:
    """For each pair of takes with transitions: how many, and the cost of the cheapest."""
    edges: dict[tuple[int, int], tuple[int, float]] = {}
    rows = (np.asarray(column).tolist() for column in (product.source, product.target, product.cost))
    for a, b, cost in zip(*rows, strict=True):
        count, best = edges.get((a, b), (0, float("inf")))
        edges[a, b] = (count + 1, min(best, cost))
    return edges


def _places(takes: list[str], edges: dict[tuple[int, int], tuple[int, float]]) -> np.ndarray:
    """Kamada-Kawai from a circle: deterministic, linked takes near each other."""
    import networkx

    graph = networkx.Graph()
    graph.add_nodes_from(range(len(takes)))
    graph.add_edges_from(pair for pair in edges if pair[0] != pair[1])
    turns = 2 * np.pi * np.arange(len(takes)) / max(len(takes), 1) + 0.35
    circle = np.stack([np.cos(turns), np.sin(turns)], 1)
    full = graph.number_of_edges() >= 0.7 * len(takes) * (len(takes) - 1) / 2
    if len(takes) < 3 or full or not networkx.is_connected(graph):
        return circle
    places = networkx.kamada_kawai_layout(graph, pos=dict(enumerate(circle)))
    return np.array([places[k] for k in range(len(takes))])


def _draw_graph(axis: Any, product: MotionGraph, takes: list[str]) -> None:
    from matplotlib.patches import FancyArrowPatch

    edges = edge_counts(product)
    places = _places(takes, edges)
    costs = [best for _, best in edges.values()]
    low, high = min(costs, default=0.0), max(costs, default=1.0)
    middle = places.mean(0)
    for (a, b), (count, best) in sorted(edges.items()):
        dear = (best - low) / (high - low) if high > low else 0.0
        style: dict[str, Any] = {
            "color": tint(INK, 0.15 + 0.55 * dear),
            "linewidth": 0.8 + 0.5 * min(count, 6),
            "mutation_scale": 12,
            "arrowstyle": "-|>",
        }
        if a == b:
            _draw_loop(axis, places[a], middle, count, style)
            continue
        arrow = FancyArrowPatch(
            places[a], places[b], connectionstyle="arc3,rad=0.17", shrinkA=26, shrinkB=28, zorder=1, **style
        )
        axis.add_patch(arrow)
        # The arc's bulge lies to the right of the way from a to b, which keeps the two directions apart.
        along = places[b] - places[a]
        at = (places[a] + places[b]) / 2 + 0.085 * np.array([along[1], -along[0]])
        _count(axis, at, count)
    for k, (take, place) in enumerate(zip(takes, places, strict=True)):
        frames = int(np.asarray(product.frames)[k])
        axis.text(
            *place,
            f"{take.replace('_', ' ')}\n{frames} frames",
            ha="center",
            va="center",
            fontsize=9,
            zorder=3,
            bbox={
                "boxstyle": "round,pad=0.5,rounding_size=0.8",
                "facecolor": tint(take_colour(k), 0.72),
                "edgecolor": take_colour(k),
                "linewidth": 1.4,
            },
        )
    reach = abs(places - middle).max(0) + [0.55, 0.5] if len(places) else np.ones(2)
    axis.set(
        xlim=(middle[0] - reach[0], middle[0] + reach[0]),
        ylim=(middle[1] - reach[1], middle[1] + reach[1]),
        aspect="equal",
    )
    outside = int((~np.asarray(product.core)).sum())
    dashed = f"\n{outside} of them (dashed) lie outside the core" if outside else ""
    title = f"{len(takes)} takes, {len(edges)} edges, {len(product.source)} transitions"
    axis.set_title(title + dashed, loc="left", fontsize=10)
    axis.axis("off")


def _draw_loop(axis: Any, place: np.ndarray, middle: np.ndarray, count: int, style: dict[str, Any]) -> None:
    """A loop on the outer side of its take."""
    from matplotlib.patches import FancyArrowPatch

    out = place - middle
    length = float(np.linalg.norm(out))
    out = out / length if length > 1e-9 else np.array([0.0, 1.0])
    side = np.array([out[1], -out[0]])
    a, b = ((place + 0.14 * out + s * side).tolist() for s in (-0.14, 0.14))
    axis.add_patch(FancyArrowPatch(a, b, connectionstyle="arc3,rad=-1.3", zorder=1, **style))
    _count(axis, place + 0.35 * out, count)


def _count(axis: Any, at: np.ndarray, count: int) -> None:
    axis.text(
        *at,
        str(count),
        ha="center",
        va="center",
        fontsize=8,
        color=SOFT_INK,
        zorder=2,
        bbox={"boxstyle": "circle,pad=0.2", "facecolor": PAPER, "edgecolor": RULE, "linewidth": 0.6},
    )


def _draw_times(axis: Any, product: MotionGraph, takes: list[str]) -> None:
    """Each take a bar of its frames; each transition a line from where it leaves to where it enters."""
    frames = np.asarray(product.frames)
    for k, take in enumerate(takes):
        axis.barh(k, int(frames[k]), height=0.26, color=tint(take_colour(k), 0.55), zorder=2)
        axis.text(0, k - 0.2, take.replace("_", " "), fontsize=8.5, va="bottom", color=INK)
    columns = (product.source, product.target, product.source_frame, product.target_frame, product.core)
    for a, b, m, n, core in zip(*(np.asarray(column).tolist() for column in columns), strict=True):
        bulge = 0.42 if a == b else 0.0
        t = np.linspace(0, 1, 30)
        x = m + (n - m) * t * t * (3 - 2 * t)
        y = a + (b - a) * t + bulge * 4 * t * (1 - t)
        axis.plot(x, y, color=take_colour(a), lw=0.9, ls="-" if core else "--", alpha=0.75)
        axis.plot([m], [a], "o", color=take_colour(a), markersize=3.2, zorder=3)
        axis.plot([n], [b], ">", color=ACCENT, markersize=4, zorder=3)
    axis.set(ylim=(len(takes) - 0.4, -0.7), xlabel="frame")
    axis.set_yticks([])
    axis.spines["left"].set_visible(False)
    axis.set_title("dots leave, arrow heads enter", loc="left", fontsize=9.5, color=SOFT_INK)
