"""A motion graph in which play never ends."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.strong_part import around, follows
from reperform.nodes.products.motion import MotionGraph
from reperform.nodes.products.pruned_graph import PrunedGraph, PruningReport

_WHO = "motion_graph.prune"
_REASONS = {
    (True, False): "leads into a dead end",
    (False, True): "cannot be come back to",
    (False, False): "apart from the core",
    (True, True): "apart from the core",
}


@node(over="dataset")
def prune(graph: MotionGraph) -> PrunedGraph:
    """Keep the core of a motion graph, its largest strongly connected part, and tell what went and why.

    A transition goes because no walk from it leads back into the core (a dead end), no walk of the core comes to
    it, or both; a take goes where no transition is left that leaves or enters it. Costs are those of the graph; nan
    for takes.

    Raises ValueError where the graph has no core.
    Source: Kovar, Gleicher and Pighin 2002, SIGGRAPH, section 3.3 (pruning); 000 section 4.3.
    """
    core = np.asarray(graph.core)
    if not core.any():
        raise ValueError(f"{_WHO}: the graph has no loop: allow more transitions or a higher threshold")
    takes = list(map(str, np.asarray(graph.takes)))
    source, target = np.asarray(graph.source), np.asarray(graph.target)
    m, n, length = (np.asarray(column) for column in (graph.source_frame, graph.target_frame, graph.length))
    reached, returns = around(follows(source, target, m - length, n + length), core)
    rows = [
        (
            f"{takes[source[k]]}:{m[k]} > {takes[target[k]]}:{n[k]}",
            float(graph.cost[k]),
            _REASONS[bool(reached[k]), bool(returns[k])],
        )
        for k in np.flatnonzero(~core).tolist()
    ]
    kept = sorted({*source[core].tolist(), *target[core].tolist()})
    rows += [(take, np.nan, "no transition left") for k, take in enumerate(takes) if k not in kept]
    what, cost, why = zip(*rows, strict=True) if rows else ((), (), ())
    report = PruningReport(np.array(what, str), np.array(cost, np.float64), np.array(why, str))
    return PrunedGraph(_kept(graph, core, kept), report)


def _kept(graph: MotionGraph, core: np.ndarray, takes: list[int]) -> MotionGraph:
    number = np.full(len(np.asarray(graph.takes)), -1, np.int32)
    number[takes] = np.arange(len(takes))
    columns = {
        name: np.asarray(getattr(graph, name))[core]
        for name in ("source_frame", "target_frame", "length", "cost", "yaw", "offset", "core")
    }
    return MotionGraph(
        takes=np.asarray(graph.takes)[takes],
        frames=np.asarray(graph.frames)[takes],
        source=number[np.asarray(graph.source)[core]],
        target=number[np.asarray(graph.target)[core]],
        fps=np.asarray(graph.fps),
        **columns,
    )
