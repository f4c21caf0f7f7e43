"""The best motion between key frames, by integer programming."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.walk_programme import enumerate_pieces, solve_programme
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph, MotionPath
from reperform.nodes.synthesis.key_frame_parameters import (
    Distance,
    DistanceTolerance,
    DistanceWeight,
    Duration,
    DurationTolerance,
    DurationWeight,
    End,
    Start,
    Via,
)
from reperform.nodes.synthesis.key_frame_targets import (
    asked_targets,
    infeasible,
    moves_between,
    nearest_walk,
    path_of,
)

_WHO = "synthesis.key_frames_ilp"


@node(over="dataset", memory=1.0)
def key_frames_ilp(
    graph: MotionGraph,
    meshes: Dataset[MeshSequence],
    *,
    start: Start,
    end: End,
    via: Via = (),
    distance: Distance = None,
    duration: Duration = None,
    distance_weight: DistanceWeight = 10 / 3,
    duration_weight: DurationWeight = 2.5,
    distance_tolerance: DistanceTolerance = 0.05,
    duration_tolerance: DurationTolerance = 0.08,
    longest: Annotated[
        float, Param("s", 0.1, 600.0, "longest loop-free walk or loop when no duration is asked")
    ] = 30.0,
    walks: Annotated[int, Param("1", 1, 10**6, "loop-free walks at most")] = 2000,
    loops: Annotated[int, Param("1", 1, 10**6, "loops at most")] = 3000,
) -> MotionPath:
    """The same motion as `synthesis.key_frames`, as loop-free walks with loops attached: the baseline.

        minimise  c . n + distance_weight |d . n - d_V| + duration_weight |t . n - t_V|,  n_0 = 1,  n_i = 0, 1, ...

    for every loop-free walk (piece 0) with all loops of the graph (costs c, lengths d, times t), each by an integer
    program (HiGHS); the cheapest wins. All pieces are enumerated, so the cost is the least there is, and the bound.
    Their number explodes with the transitions of the graph: meant for small graphs and for comparison.

    Raises ValueError where a key frame does not exist, key frames cannot be joined, no walk is within the tolerances
    (naming the nearest distance and duration that can be met), or there are more pieces than allowed.

    Source: Huang, Tejera, Collomosse and Hilton 2015, ACM TOG (000 section 5.1, eqs 14-25).
    Departure: the target is subtracted once, not once per loop (eq 24), with slack variables for the absolute
    values instead of four sub-problems; loops must connect to the walk.
    """
    rate, keys = float(graph.fps), (start, *via, end)
    asked = asked_targets(
        distance, duration, (distance_weight, duration_weight), (distance_tolerance, duration_tolerance), rate, _WHO
    )  # fmt: skip
    moves, spots = moves_between(graph, meshes, keys, _WHO)
    horizon = int(np.ceil((longest if duration is None else duration + duration_tolerance) * rate))
    walk = solve_programme(moves, enumerate_pieces(moves, horizon, walks, loops), asked)
    if walk is None:
        raise ValueError(infeasible(keys, asked, nearest_walk(moves, asked, rate), rate, True, _WHO))
    return path_of(graph, meshes, spots, walk, asked, _WHO)
