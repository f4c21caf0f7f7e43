"""The search along a curve against depth-first search, and against the optimum where that can be had."""

from __future__ import annotations

import time
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.curve_walk import curve_walk
from reperform.nodes.kernels.depth_first_walk import depth_first_walk
from reperform.nodes.product import Dataset, Pairs
from reperform.nodes.products.essential import PoseGraph
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.synthesis.curve_problem import CurveProblem, curve_problem
from reperform.nodes.synthesis.pose_graph_walk import Graph, graph_of

_WHO = "evaluate.curve_search"
# Depth-first search is given more moves by this factor until it has been as good or its time is up.
_MORE = 4


@node(over="dataset", volatile=True, memory=2.0)
def curve_search(
    graph: PoseGraph,
    similarity: Pairs[Dissimilarity],
    meshes: Dataset[MeshSequence],
    *,
    curve: Annotated[
        tuple[tuple[float, float], ...], Param("m", about="points (x, z) that the way goes through")
    ],
    actions: Annotated[tuple[str, ...], Param(about="FROM-TO TAKE, as for synthesis.along_curve")] = (),
    start: Annotated[str, Param(about="the first pose, as TAKE:FRAME; empty: any")] = "",
    distance_weight: Annotated[
        float, Param("1/m", 0.0, 1e6, "cost of a frame one metre off the curve")
    ] = 0.2,
    beam: Annotated[int, Param("1", 1, 100_000, "walks followed per stretch and frame")] = 4,
    patience: Annotated[
        float, Param("1", 1.0, 1000.0, "times the table's seconds that depth-first search gets")
    ] = 12.0,
    small: Annotated[int, Param("1", 1, 200, "small problems whose optimum is proved")] = 8,
    length: Annotated[float, Param("m", 0.1, 10.0, "of the small problems' curves")] = 0.8,
    most: Annotated[int, Param("1", 1, 10**10, "moves tried to prove one optimum")] = 30_000_000,
    seed: Annotated[int, Param("1", 0, 2**31 - 1, "of the small problems")] = 0,
) -> Measures:
    """How much faster the table over arc length finds as good a walk, and how far its walks are from the best.

    On the given curve, one row: `speedup`, seconds of depth-first search over those of the table, the former until it
    is as cheap, or out of patience (then it would take more); `cost ratio`, the table's cost over what depth-first
    search then has (nan: it has none); `seconds` of the table. On `small` seeded curves from single poses, arcs of
    random bend: `gap`, the greatest (cost - optimum) / optimum, the optimum by depth-first search with the lower
    bound, run to its end; `proved`, the share of them that got to their end within `most` moves (the others do not
    count).

    Raises as synthesis.along_curve.
    Source: 002 section 4 (Boukhayma and Boyer 2015, 3DV) uses depth-first search with branch and bound.
    """
    ready = graph_of(graph, similarity, meshes, _WHO)
    problem = curve_problem(ready, curve, actions, start, distance_weight, _WHO)
    curve_walk(problem.trail, problem.rest, problem.starts, 1)
    begin = time.perf_counter()
    walk = curve_walk(problem.trail, problem.rest, problem.starts, beam)
    own = time.perf_counter() - begin
    if walk is None:
        raise ValueError(
            f"{_WHO}: no walk was found along the curve: raise beam, or leave gaps between actions"
        )
    cost, taken = _depth_first(problem, walk.cost, patience * own)
    gaps = _gaps(ready, distance_weight, beam, small, length, most, seed)
    known = gaps[np.isfinite(gaps)]
    values = {
        "speedup": (taken / own, "1"),
        "cost ratio": (walk.cost / cost if np.isfinite(cost) else np.nan, "1"),
        "seconds": (own, "s"),
        "gap": (float(known.max()) if len(known) else np.nan, "1"),
        "proved": (len(known) / len(gaps), "1"),
    }
    return Measures(
        np.array([[value for value, _ in values.values()]]),
        np.array(list(values)),
        np.array([unit for _, unit in values.values()]),
    )


def _depth_first(problem: CurveProblem, cost: float, seconds: float) -> tuple[float, float]:
    """The cost that the seed's search gets to, and the seconds it takes to be as good or until its time is up."""
    depth_first_walk(problem.trail, None, problem.starts, 1)
    tried = 100_000
    while True:
        begin = time.perf_counter()
        found, done = depth_first_walk(problem.trail, None, problem.starts, tried)
        taken = time.perf_counter() - begin
        reached = np.inf if found is None else found.cost
        if reached <= cost or done or taken >= seconds:
            return reached, taken
        # up to the moves that fill the time, and a little more
        tried = min(_MORE * tried, int(1.1 * tried * seconds / taken) + 1)


def _gaps(
    graph: Graph, distance_weight: float, beam: int, small: int, length: float, most: int, seed: int
) -> np.ndarray:
    """(cost - optimum) / optimum of seeded small problems; nan where the optimum was not proved."""
    random = np.random.default_rng(seed)
    gaps = np.full(small, np.nan)
    names = [
        f"{take}:{frame}"
        for take, count in zip(graph.takes, graph.frames, strict=True)
        for frame in range(count - 1)
    ]
    for k in range(small):
        bend = random.uniform(-1.0, 1.0) / length
        heading = bend * np.linspace(0.0, length, 9)
        points = np.cumsum(np.column_stack([np.sin(heading), np.cos(heading)]) * length / 8, axis=0)
        problem = curve_problem(
            graph, points.tolist(), (), names[random.integers(len(names))], distance_weight, _WHO
        )
        walk = curve_walk(problem.trail, problem.rest, problem.starts, beam)
        best, done = depth_first_walk(problem.trail, problem.rest, problem.starts, most)
        if walk is not None and best is not None and done:
            gaps[k] = (walk.cost - best.cost) / best.cost
    return gaps
