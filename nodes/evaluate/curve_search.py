"""The search along a curve against depth-first search, and against the optimum where that can be had."""

from __future__ import annotations

import time
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.curve_reach import curve_reach
from reperform.nodes.kernels.curve_walk import curve_walk, remaining_cost
from reperform.nodes.kernels.depth_first_walk import depth_first_walk
from reperform.nodes.product import Dataset, Pairs
from reperform.nodes.products.essential import PoseGraph
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.synthesis.curve_problem import CurveProblem, curve_problem
from reperform.nodes.synthesis.pose_graph_walk import Graph, graph_of

_WHO = "evaluate.curve_search"
# Moves by which the pace of depth-first search is taken, to know how many fill its time.
_PACE = 1_000_000
# The seeded curves bend by at most so much (1/m), anew every so many metres.
_BEND, _PIECE = 0.6, 1.0
# Frames over which the proofs look ahead to bound the distances.
_LOOK = 60


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
    beam: Annotated[
        int, Param("1", 1, 100_000, "walks followed per stretch, as for synthesis.along_curve")
    ] = 1000,
    patience: Annotated[
        float, Param("1", 1.0, 1000.0, "times the table's seconds that depth-first search gets")
    ] = 12.0,
    curves: Annotated[int, Param("1", 0, 100, "seeded curves timed besides the given one")] = 3,
    way: Annotated[float, Param("m", 1.0, 100.0, "of each of them")] = 7.0,
    small: Annotated[int, Param("1", 1, 200, "small problems whose optimum is proved")] = 32,
    length: Annotated[float, Param("m", 0.1, 10.0, "of the small problems' curves")] = 0.8,
    most: Annotated[int, Param("1", 1, 10**10, "moves tried to prove one optimum")] = 30_000_000,
    seed: Annotated[int, Param("1", 0, 2**31 - 1, "of the curves and the small problems")] = 0,
) -> Measures:
    """How much faster the table over arc length finds as good a walk, and how far its walks are from the best.

    One row per curve, the given one and `curves` seeded ones, then one per small problem. On a curve: `seconds` of the
    table, the bound it needs included; `speedup`, seconds of depth-first search over these, the former until its walk
    costs no more than the table's, or until `patience` is over: it is then a lower bound; `reached`, whether it got
    there; `cost ratio`, the table's cost over that of the best walk that depth-first search then has (nan: none).
    Seconds are those of the processor, of one thread. On `small` seeded problems from single poses, arcs of random
    bend: `proved`, whether depth-first search with lower bounds, which looks for cheaper walks only, got to its end
    within `most` moves; `gap`, (cost - optimum) / optimum where it did, and where it did not but found a cheaper walk,
    that walk's in place of the optimum.

    Raises as synthesis.along_curve.
    Source: 002 section 4 (Boukhayma and Boyer 2015, 3DV) uses depth-first search with branch and bound.
    """
    ready = graph_of(graph, similarity, meshes, _WHO)
    ways = [curve_problem(ready, curve, actions, start, distance_weight, _WHO)]
    for k in range(curves):
        points = _points(np.random.default_rng((seed, k)), way, _PIECE, _BEND)
        ways.append(curve_problem(ready, points, (), "", distance_weight, _WHO))
    # what is compiled is so before it is timed
    curve_walk(ways[0].trail, ways[0].rest, ways[0].starts, 1)
    depth_first_walk(ways[0].trail, None, ways[0].starts, 1)
    timed = [_timed(ready, problem, beam, patience) for problem in ways]
    gaps = _gaps(ready, distance_weight, beam, small, length, most, seed)
    value = np.full((len(timed) + small, 6), np.nan)
    value[: len(timed), :4], value[len(timed) :, 4:] = timed, gaps
    return Measures(
        value,
        np.array(["seconds", "speedup", "reached", "cost ratio", "gap", "proved"]),
        np.array(["s", "1", "1", "1", "1", "1"]),
    )


def _points(random: np.random.Generator, length: float, piece: float, bend: float) -> list[list[float]]:
    """A curve of evenly bent pieces, eight points on each."""
    count = max(1, round(length / piece))
    turns = np.repeat(random.uniform(-bend, bend, count), 8) * length / count / 8
    heading = np.concatenate([[0.0], np.cumsum(turns)])
    steps = np.column_stack([np.sin(heading), np.cos(heading)]) * length / count / 8
    points: list[list[float]] = np.cumsum(steps, axis=0).tolist()
    return points


def _timed(
    graph: Graph, problem: CurveProblem, beam: int, patience: float
) -> tuple[float, float, float, float]:
    """Seconds, speedup, whether depth-first search got there, and ratio of costs."""
    begin = time.thread_time()
    walk = curve_walk(problem.trail, remaining_cost(graph.moves, problem.curve), problem.starts, beam)
    own = time.thread_time() - begin
    if walk is None:
        raise ValueError(
            f"{_WHO}: no walk was found along the curve: raise beam, or leave gaps between actions"
        )
    tried = _PACE
    while True:
        begin = time.thread_time()
        found, done = depth_first_walk(problem.trail, None, problem.starts, tried, enough=walk.cost)
        taken = time.thread_time() - begin
        cost = np.inf if found is None else found.cost
        if cost <= walk.cost or done or taken >= patience * own:
            ratio = walk.cost / cost if found is not None else np.nan
            return own, taken / own, float(cost <= walk.cost), ratio
        # as many moves as fill the time, and a little more
        tried = int(1.05 * tried * patience * own / taken) + 1


def _gaps(
    graph: Graph, distance_weight: float, beam: int, small: int, length: float, most: int, seed: int
) -> np.ndarray:
    """Gap, and whether the optimum was proved, of seeded small problems, (small, 2)."""
    random = np.random.default_rng(seed)
    reach = curve_reach(graph.moves, _LOOK)
    gaps = np.zeros((small, 2))
    names = [
        f"{take}:{frame}"
        for take, count in zip(graph.takes, graph.frames, strict=True)
        for frame in range(count - 1)
    ]
    for k in range(small):
        points = _points(random, length, length, 1.0 / length)
        name = names[random.integers(len(names))]
        problem = curve_problem(graph, points, (), name, distance_weight, _WHO)
        walk = curve_walk(problem.trail, problem.rest, problem.starts, beam)
        cost = np.inf if walk is None else walk.cost
        better, done = depth_first_walk(
            problem.trail, problem.rest, problem.starts, most, reach=reach, below=cost
        )
        least = cost if better is None else better.cost
        gaps[k] = (cost - least) / least if done or better is not None else np.nan, done
    return gaps
