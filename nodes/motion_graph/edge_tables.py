"""The tables of a parametric motion graph, edge by edge, as the search wants them."""

from __future__ import annotations

import numpy as np

from reperform.nodes.kernels.control_cells import framed
from reperform.nodes.kernels.transition_tables import EdgeTables, SpaceTables
from reperform.nodes.products.parametric import ParametricGraph


def space_tables(graph: ParametricGraph, space: int) -> SpaceTables:
    """The tables of one space."""
    graph = _small_read(graph)
    d, k, r, c = (
        int(column[space]) for column in (graph.dimensions, graph.poses, graph.references, graph.cells)
    )
    before = slice(0, space)
    halves = int(graph.halves)
    first, cell = int(graph.references[before].sum()), int(graph.cells[before].sum())
    control = np.asarray(graph.reference_control)[first : first + r, :d]
    corners = np.asarray(graph.corners)[cell : cell + c, : d + 1]
    places = (halves + 1) ** np.asarray(graph.dimensions)
    at_place = int((graph.cells[before] * places[before]).sum())
    at_step = int((graph.references[before] * graph.poses[before]).sum())
    at_spread = int(
        (graph.poses[before].astype(np.int64) * graph.references[before].astype(np.int64) ** 2).sum()
    )
    seconds = np.asarray(graph.seconds)[at_step : at_step + r * k].reshape(r, k)
    places_here = np.array(graph.lattice[at_place : at_place + c * places[space]].reshape(c, -1))
    spread, stride = (
        np.array(table[at_spread : at_spread + k * r * r].reshape(k, r, r))
        for table in (graph.spread, graph.stride)
    )
    return SpaceTables(
        framed(control, corners),
        places_here,
        halves,
        bool(graph.cyclic[space]),
        np.concatenate([np.zeros((r, 1)), np.cumsum(np.tile(seconds, 2), axis=1)], axis=1),
        np.ascontiguousarray(seconds.min(axis=0)),
        spread,
        stride,
        np.array(control),
    )


def _slack(space: SpaceTables) -> np.ndarray:
    """How much nearer than the references themselves a blend of them and of two poses can be (K,), m^2.

    sum_p>q w_p w_q s_pq <= max s_pq (1 - 1/(d + 1)) / 2 over references that are neighbours, and a (1 - a) |step|^2 <=
    |step|^2 / 4 between a pose and the next.
    """
    control, d = space.control, space.control.shape[1]
    gap = np.abs(control[:, None] - control[None]).max(axis=2)
    near = gap <= 1.0 / space.halves + 1e-9
    loosest = np.where(near, space.spread, 0.0).max(axis=(1, 2)) * (1.0 - 1.0 / (d + 1)) / 2.0
    longest = np.diagonal(space.stride, axis1=1, axis2=2).max(axis=1)
    return np.asarray(np.maximum(loosest, np.roll(loosest, -1)) + longest / 4.0, np.float64)


def edge_tables(graph: ParametricGraph, edge: int) -> EdgeTables:
    """The tables of one edge."""
    graph = _small_read(graph)
    rows = graph.poses.astype(np.int64) * graph.references.astype(np.int64)
    size = rows[graph.source] * rows[graph.target]
    start = int(size[:edge].sum())
    source, target = int(graph.source[edge]), int(graph.target[edge])
    shape = (
        int(graph.poses[source]), int(graph.references[source]), int(graph.poses[target]), int(graph.references[target])
    )  # fmt: skip
    table = np.array(graph.distance[start : start + size[edge]]).reshape(shape)
    one, two = space_tables(graph, source), space_tables(graph, target)
    least = table.min(axis=(1, 3)).astype(np.float64)
    for axis in (0, 1):
        least = np.minimum(least, np.roll(least, -1, axis=axis))
    least -= _slack(one)[:, None] + _slack(two)[None, :]
    return EdgeTables(one, two, table, np.ascontiguousarray(least), float(graph.largest))


def _small_read(graph: ParametricGraph) -> ParametricGraph:
    """The graph with all but its distances read."""
    fields = zip(graph._fields, graph, strict=True)
    return ParametricGraph(*(field if name == "distance" else np.asarray(field) for name, field in fields))


def find_edge(graph: ParametricGraph, source: str, target: str) -> int:
    """The edge between two spaces by name. Raises ValueError where there is none."""
    names = np.asarray(graph.spaces)
    for edge in range(len(graph.source)):
        if names[graph.source[edge]] == source and names[graph.target[edge]] == target:
            return edge
    known = ", ".join(f"{names[s]}>{names[t]}" for s, t in zip(graph.source, graph.target, strict=True))
    raise ValueError(f"motion_graph.parametric: no edge {source}>{target}; there are {known}")
