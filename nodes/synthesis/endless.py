"""Motion that goes on for as long as wanted."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.path_frames import PathFrames, path_frames
from reperform.nodes.kernels.strong_part import follows
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph, MotionPath
from reperform.nodes.synthesis.graph_walk import ground_tracks, motion_path, passages_of

_WHO = "synthesis.endless"


@node(over="dataset")
def endless(
    graph: MotionGraph,
    meshes: Dataset[MeshSequence],
    *,
    seconds: Annotated[float, Param("s", 0.04, 3600.0, "length of the motion")] = 20.0,
    seed: Annotated[int, Param("1", 0, 2**31 - 1, "seed of the walk")] = 0,
    choosiness: Annotated[float, Param("1", 0.0, 1000.0, "how much cheap transitions are preferred")] = 6.0,
    variety: Annotated[float, Param("1", 0.0, 10.0, "how much transitions taken before are avoided")] = 2.0,
) -> MotionPath:
    """A random walk through the core of a motion graph, exactly `seconds` long; it never dies.

    From each arrival one of the core transitions that can follow is drawn with probability proportional to
    exp(-choosiness cost) / (1 + times taken)^variety. The core is strongly connected, so there always is one.
    Same seed, same walk. cost and bound: the sum of the costs taken, and 0.

    Raises ValueError where the graph has no core (no loop).

    Source: Kovar, Gleicher and Pighin 2002, SIGGRAPH, section 4 (003 section 3.2.1: random walks).
    Departure: probabilities fall with cost and with use, so that it neither stutters nor repeats itself.
    """
    core = np.flatnonzero(np.asarray(graph.core))
    if len(core) == 0:
        raise ValueError(
            f"{_WHO}: the graph has no loop to play endlessly: allow more transitions or a higher threshold"
        )
    passages, tracks = passages_of(graph), ground_tracks(graph, meshes, _WHO)
    costs = np.asarray(graph.cost, np.float64)
    after = follows(
        *(
            np.array([getattr(passages[k], name) for k in core])
            for name in ("source", "target", "departure", "arrival")
        )
    )
    count = max(2, round(seconds * float(graph.fps)))
    random = np.random.default_rng(seed)
    taken: list[int] = []
    used = np.zeros(len(core))
    here = int(random.integers(len(core)))
    first = passages[core[here]]
    played = 0
    frame = first.arrival
    while played < count:
        choices = np.flatnonzero(after[here])
        odds = (
            np.exp(-choosiness * (costs[core[choices]] - costs[core[choices]].min()))
            / (1 + used[choices]) ** variety
        )
        here = int(choices[np.searchsorted(np.cumsum(odds) / odds.sum(), random.random())])
        used[here] += 1
        passage = passages[core[here]]
        played += passage.departure - frame + 2 * passage.length
        frame = passage.arrival
        taken.append(int(core[here]))
    walk = [passages[k] for k in taken]
    frames = path_frames(first.target, first.arrival, walk, walk[-1].arrival)
    frames = PathFrames(*(column[:count] for column in frames))
    return motion_path(
        graph, frames, tracks, taken, duration=seconds, cost=float(costs[taken].sum()), bound=0.0
    )
