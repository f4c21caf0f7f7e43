"""Layered left-to-right layout of a directed acyclic graph, with few crossings."""

from __future__ import annotations

import itertools
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

Node = Hashable
SWEEPS = 24


@dataclass(frozen=True)
class Layout:
    """Where each node stands and the way points of each edge.

    layer: column of each node.  centre: vertical centre of each node, downwards, from 0.  through: for each
    edge the vertical position at which it crosses each column between its ends.
    """

    layer: dict[Node, int]
    centre: dict[Node, float]
    through: dict[tuple[Node, Node], list[float]]
    height: float


def layered_layout(
    nodes: Sequence[Node],
    edges: Sequence[tuple[Node, Node]],
    heights: Mapping[Any, float],
    gap: float,
    lane: float,
) -> Layout:
    """Place nodes in columns: sources before targets, edges short, straight and rarely crossing.

    heights: height of each node.  gap: least free space between two nodes of a column.  lane: height that an
    edge needs where it passes through a column.  The same input gives the same layout.

    Raises ValueError where the edges have a cycle.

    Source: Sugiyama, Tagawa, Toda 1981, IEEE Trans. SMC 11(2); Gansner, Koutsofios, North, Vo 1993, IEEE TSE
    19(3). Departure: positions by averaged neighbour sweeps instead of network simplex.
    """
    edges = list(dict.fromkeys(edges))
    layer = _layers(nodes, edges)
    columns, links, chains = _with_lanes(nodes, edges, layer)
    _uncross(columns, links)
    size = {part: heights[part] if part in layer else lane for column in columns for part in column}
    centre = _positions(columns, links, size, gap)
    top = min((centre[part] - size[part] / 2 for part in centre), default=0.0)
    centre = {part: value - top for part, value in centre.items()}
    bottom = max((centre[part] + size[part] / 2 for part in centre), default=0.0)
    through = {edge: [centre[part] for part in chain] for edge, chain in chains.items()}
    return Layout(layer, {node: centre[node] for node in nodes}, through, bottom)


def _layers(nodes: Sequence[Node], edges: Sequence[tuple[Node, Node]]) -> dict[Node, int]:
    """Longest path from the sources; a source then moves right, next to the first that reads it."""
    before: dict[Node, list[Node]] = {node: [] for node in nodes}
    after: dict[Node, list[Node]] = {node: [] for node in nodes}
    for a, b in edges:
        before[b].append(a)
        after[a].append(b)
    waiting = {node: len(before[node]) for node in nodes}
    ready = [node for node in nodes if not waiting[node]]
    layer: dict[Node, int] = {}
    while ready:
        node = ready.pop(0)
        layer[node] = max((layer[source] + 1 for source in before[node]), default=0)
        for target in after[node]:
            waiting[target] -= 1
            if not waiting[target]:
                ready.append(target)
    if len(layer) < len(nodes):
        ring = [str(node) for node in nodes if node not in layer]
        raise ValueError(f"a layered drawing needs a graph without cycles, got one among {', '.join(ring)}")
    for node in nodes:
        if not before[node] and after[node]:
            layer[node] = min(layer[target] for target in after[node]) - 1
    return layer


def _with_lanes(
    nodes: Sequence[Node], edges: Sequence[tuple[Node, Node]], layer: Mapping[Node, int]
) -> tuple[list[list[Node]], list[tuple[Node, Node]], dict[tuple[Node, Node], list[Node]]]:
    """Columns with lanes for the long edges, links between neighbours, and the lanes of each edge.

    All edges that leave one node share its lanes: they run as one line until they part.
    """
    columns: list[list[Node]] = [[] for _ in range(max(layer.values(), default=-1) + 1)]
    for node in nodes:
        columns[layer[node]].append(node)
    links: list[tuple[Node, Node]] = []
    chains: dict[tuple[Node, Node], list[Node]] = {}
    for a, b in edges:
        chain: list[Node] = [("lane", a, k) for k in range(layer[a] + 1, layer[b])]
        for k, part in enumerate(chain):
            if part not in columns[layer[a] + 1 + k]:
                columns[layer[a] + 1 + k].append(part)
        chains[a, b] = chain
        way = [a, *chain, b]
        links += itertools.pairwise(way)
    return columns, list(dict.fromkeys(links)), chains


def _neighbours(links: Sequence[tuple[Node, Node]]) -> tuple[dict[Node, list[Node]], dict[Node, list[Node]]]:
    left: dict[Node, list[Node]] = {}
    right: dict[Node, list[Node]] = {}
    for a, b in links:
        right.setdefault(a, []).append(b)
        left.setdefault(b, []).append(a)
    return left, right


def _crossings(columns: Sequence[Sequence[Node]], right: Mapping[Node, Sequence[Node]]) -> int:
    rank = {part: k for column in columns for k, part in enumerate(column)}
    total = 0
    for column in columns:
        ends = [rank[b] for a in column for b in sorted(right.get(a, ()), key=rank.__getitem__)]
        total += sum(first > second for k, first in enumerate(ends) for second in ends[k + 1 :])
    return total


def _uncross(columns: list[list[Node]], links: Sequence[tuple[Node, Node]]) -> None:
    """Order the columns in place by barycentre sweeps to and fro; the best order seen stays."""
    left, right = _neighbours(links)
    best, fewest = [list(column) for column in columns], _crossings(columns, right)
    for sweep in range(SWEEPS):
        forward = sweep % 2 == 0
        side = left if forward else right
        for k in range(len(columns)) if forward else range(len(columns) - 1, -1, -1):
            rank = {part: place for column in columns for place, part in enumerate(column)}
            columns[k].sort(key=lambda part: _mean([rank[n] for n in side.get(part, ())], rank[part]))
        now = _crossings(columns, right)
        if now < fewest:
            best, fewest = [list(column) for column in columns], now
    columns[:] = best


def _mean(values: Sequence[float], otherwise: float) -> float:
    return sum(values) / len(values) if values else otherwise


def _positions(
    columns: Sequence[Sequence[Node]],
    links: Sequence[tuple[Node, Node]],
    size: Mapping[Node, float],
    gap: float,
) -> dict[Node, float]:
    """Each part as near as it can be to the mean of its neighbours, in order, without touching."""
    left, right = _neighbours(links)
    centre: dict[Node, float] = {}
    for column in columns:
        total = sum(size[part] for part in column) + gap * (len(column) - 1)
        y = -total / 2
        for part in column:
            centre[part] = y + size[part] / 2
            y += size[part] + gap
    for sweep in range(SWEEPS):
        forward = sweep % 2 == 0
        for column in columns if forward else reversed(columns):
            first, second = (left, right) if forward else (right, left)
            wish = [
                _mean([centre[n] for n in first.get(part, ()) or second.get(part, ())], centre[part])
                for part in column
            ]
            for part, y in zip(column, _spread(wish, [size[part] for part in column], gap), strict=True):
                centre[part] = y
    return centre


def _spread(wish: Sequence[float], size: Sequence[float], gap: float) -> list[float]:
    """The positions nearest to the wishes (least squares) in the given order with the given room.

    Subtracting the room each part needs makes the order constraint a monotone one: isotonic regression by
    pooling neighbours.
    """
    if not wish:
        return []
    room = [0.0]
    for a, b in itertools.pairwise(size):
        room.append(room[-1] + (a + b) / 2 + gap)
    pools: list[list[float]] = []
    for value, offset in zip(wish, room, strict=True):
        pools.append([value - offset, 1.0])
        while len(pools) > 1 and pools[-2][0] > pools[-1][0]:
            mean, count = pools.pop()
            pools[-1] = [
                (pools[-1][0] * pools[-1][1] + mean * count) / (pools[-1][1] + count),
                pools[-1][1] + count,
            ]
    flat = [mean for mean, count in pools for _ in range(int(count))]
    return [value + offset for value, offset in zip(flat, room, strict=True)]
