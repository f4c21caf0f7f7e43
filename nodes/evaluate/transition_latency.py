"""How soon and how smoothly a character passes from one motion to another."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.fixed_transitions import fixed_transition
from reperform.nodes.kernels.transition_search import best_transition, new_found
from reperform.nodes.kernels.transition_tables import EdgeTables
from reperform.nodes.motion_graph.edge_tables import edge_tables, find_edge
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.parametric import ParametricGraph

FIXED = (1, 5, 10)
DEPTHS = (3, 4, 5, 6, 7, 8, 9, 10, 11, 12)
_REPEATS = 9
_DRAWS = 10000

State = tuple[int, np.ndarray, int, np.ndarray]
Method = Callable[[State], np.ndarray | None]


@node(over="dataset", volatile=True)
def transition_latency(
    graph: ParametricGraph,
    *,
    edge: Annotated[str, Param(about="the edge that is measured: SOURCE>TARGET")] = "walk>jump",
    draws: Annotated[int, Param("1", 1, 1000, "random transitions")] = 50,
    seed: Annotated[int, Param("1", 0, None, "of the draws")] = 0,
) -> Measures:
    """Table 4.2 of 004: cost, latency and time of 1, 5, 10 fixed transitions and of trellises of depth 3 to 12.

    One row per draw, a random state of the source and one of the target; entries `shape M` (E_S, thousandths of the
    largest dissimilarity), `latency cost M` (lambda E_L), `latency M` s from the state to the wanted state, `time M` s
    (median of repeats), M being `1 fixed` .. or `depth 3` ..; draws in which any method finds no way (a motion that
    is not cyclic has gone past all fixed transitions) are drawn again, for all methods alike. Last entries, the same
    in every row: means at depth 10 over those of 10 fixed: `cost ratio` (E_S + lambda E_L), `shape ratio`,
    `latency ratio`.

    Raises ValueError where the graph has no such edge, or no draw is within reach of all methods.
    Source: 004 table 4.2, section 4.4.5.
    """
    number = find_edge(graph, *edge.split(">"))
    tables = edge_tables(graph, number)
    methods = _methods(graph, number, tables)
    rng = np.random.default_rng(seed)
    rows: list[list[float]] = []
    for _ in range(_DRAWS):
        state = _draw(rng, tables)
        results = [method(state) for method in methods.values()]
        if all(result is not None for result in results):
            rows.append([])
            for method, result in zip(methods.values(), results, strict=True):
                rows[-1] += [result[0], result[1], result[2] + result[3], _seconds(method, state)]  # type: ignore[index]
            if len(rows) == draws:
                break
    if len(rows) < draws:
        raise ValueError(
            f"evaluate.transition_latency: {draws} transitions {edge} within reach of all methods needed, got "
            f"{len(rows)} of {_DRAWS} draws: give the graph more fixed transitions"
        )
    names = [f"{what} {name}" for name in methods for what in ("shape", "latency cost", "latency", "time")]
    table = np.array(rows)
    ours, theirs = (dict(zip(names, table.mean(axis=0), strict=True)) for _ in range(2))
    online, fixed = f"depth {10}", f"{FIXED[-1]} fixed"
    ratios = {
        "cost ratio": (ours[f"shape {online}"] + ours[f"latency cost {online}"])
        / (theirs[f"shape {fixed}"] + theirs[f"latency cost {fixed}"]),
        "shape ratio": ours[f"shape {online}"] / theirs[f"shape {fixed}"],
        "latency ratio": ours[f"latency {online}"] / theirs[f"latency {fixed}"],
    }
    return Measures(
        np.concatenate([table, np.tile(list(ratios.values()), (draws, 1))], axis=1),
        np.array([*names, *ratios]),
        np.array(["1", "1", "s", "s"] * len(methods) + ["1"] * len(ratios)),
    )


def _methods(graph: ParametricGraph, edge: int, tables: EdgeTables) -> dict[str, Method]:
    weight, step = float(np.asarray(graph.latency_weight)), float(np.asarray(graph.step))
    mine = np.asarray(graph.fixed_edge) == edge
    poses, references, costs = (
        np.array(np.asarray(field)[mine])
        for field in (graph.fixed_pose, graph.fixed_reference, graph.fixed_cost)
    )
    found, out = new_found(tables, DEPTHS[-1], step), np.zeros(4)

    def fixed(count: int) -> Method:
        first = poses[:count].copy(), references[:count].copy(), costs[:count].copy()

        def method(state: State) -> np.ndarray | None:
            return out.copy() if fixed_transition(tables, *first, *state, step, weight, out) else None

        return method

    def online(depth: int) -> Method:
        def method(state: State) -> np.ndarray | None:
            able = best_transition(tables, *state, depth, step, weight, 1.0, found)
            return found.cost.copy() if able else None

        return method

    return {f"{n} fixed": fixed(n) for n in FIXED} | {f"depth {n}": online(n) for n in DEPTHS}


def _draw(rng: np.random.Generator, tables: EdgeTables) -> State:
    """A random state of the source and of the target."""
    (pose, control), (other, other_control) = (
        (int(rng.integers(side.spread.shape[0])), rng.random((side.control.shape[1],)))
        for side in (tables.source, tables.target)
    )
    return pose, control, other, other_control


def _seconds(method: Method, state: State) -> float:
    taken = []
    for _ in range(_REPEATS):
        start = time.perf_counter()
        method(state)
        taken.append(time.perf_counter() - start)
    return float(np.median(taken))
