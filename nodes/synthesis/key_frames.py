"""The best motion between key frames."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.ground_plane import align
from reperform.nodes.kernels.placed_search import Goal, best_placed
from reperform.nodes.kernels.prepared_search import PreparedSearch
from reperform.nodes.kernels.walk_moves import Spot
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph, MotionPath
from reperform.nodes.synthesis.graph_walk import passages_of
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

_WHO = "synthesis.key_frames"
# Walks kept of each place and number of steps where position or heading count.
_WIDTH = 100
# Labels that the proof may take: filling the table takes longer.
_EFFORT = 2_000_000


@node(over="dataset", memory=1.5)
def key_frames(
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
    position: Annotated[
        tuple[float, ...],
        Param("m", about="where to end on the ground: x, z from where it starts; empty: anywhere"),
    ] = (),
    heading: Annotated[
        float | None, Param("rad", -10.0, 10.0, "how far the performer turns from start to end")
    ] = None,
    position_weight: Annotated[float, Param("1/m", 0.0, 1e6, "cost of a metre away from the position")] = 10
    / 3,
    heading_weight: Annotated[float, Param("1/rad", 0.0, 1e6, "cost of a radian off the heading")] = 2.0,
    longest: Annotated[
        float, Param("s", 0.1, 600.0, "longest motion considered when no duration is asked")
    ] = 30.0,
    nearest: Annotated[bool, Param(about="take the nearest motion where the targets cannot be met")] = False,
) -> MotionPath:
    """The cheapest motion that shows all key frames in order and meets the targets within their tolerances.

        C = sum of transition costs + distance_weight |dist - distance| + duration_weight |time - duration|
        dist = arc length of the centroid's track on the ground, blended frames included;  time = frames / fps

    Key frames are captured frames, shown unblended. The minimum is over all walks through the graph, loops
    included: dynamic programming bounds what remains to be paid by (place, steps, distance), and a search led by it
    tries all walks under a rising limit. `bound` is proved to be under the cost of every walk within the tolerances;
    it equals the cost where the search came to its end.

    With a position or heading, position_weight |place - position| + heading_weight |turn - heading| joins the cost
    (coordinates of the first take; turn: how the last frame is turned against the first, by least squares). Then the
    cheapest walks of each place and number of steps are kept, nearly alike ones once; `bound` disregards place.

    Raises ValueError where a key frame does not exist, the key frames cannot be joined, the position is further away
    than the distance, or no walk is within the tolerances; it then names the nearest distance and duration that can
    be met. With `nearest` that walk is returned instead, its errors to be read from the product.

    Source: Huang, Tejera, Collomosse and Hilton 2015, ACM TOG (000 section 5.1, eqs 7-13); position: 003 eq 6.
    Departure: 000 enumerates walks and attaches loops by integer programming (eqs 14-25), where the target is
    subtracted once per loop and loops need not connect; the search covers every connected walk, with tolerances
    as hard limits. Weights as in 000: 0.3 m costs as much as 10 frames at 25 Hz.
    """
    rate, keys = float(graph.fps), (start, *via, end)
    asked = asked_targets(
        distance,
        duration,
        (distance_weight, duration_weight),
        (distance_tolerance, duration_tolerance),
        rate,
        _WHO,
    )
    if not nearest:
        _agree(position, distance, distance_tolerance)
    moves, spots = moves_between(graph, meshes, keys, _WHO)
    horizon = int(np.ceil((longest if duration is None else duration + duration_tolerance) * rate))
    reach = np.inf if distance is None else distance + distance_tolerance
    answer = PreparedSearch.fill(moves, horizon, reach, distance_weight).ask(asked, _EFFORT)
    walk = answer.walk
    if walk is not None and (position or heading is not None):
        goal = _goal(graph, meshes, spots, position, heading, (position_weight, heading_weight))
        placed = best_placed(moves, passages_of(graph), asked, goal, horizon, _WIDTH)
        walk = placed if placed is not None else walk
    if walk is None:
        walk = nearest_walk(moves, asked, rate)
        if (walk.steps > horizon or max(asked.off(walk.distance, walk.steps)) > 1.0) and not nearest:
            cure = ", raise longest, or set nearest: true" if duration is None else ", or set nearest: true"
            raise ValueError(infeasible(keys, asked, walk, rate, answer.proved, _WHO) + cure)
    return path_of(graph, meshes, spots, walk, asked, _WHO)


def _agree(position: tuple[float, ...], distance: float | None, tolerance: float) -> None:
    """No way is shorter than the straight one."""
    away = float(np.hypot(*position)) if len(position) == 2 else 0.0
    if distance is not None and away > distance + tolerance:
        raise ValueError(
            f"{_WHO}: no motion of {distance:g} m ends {away:.3f} m from where it starts: ask for a distance of "
            f"{away - tolerance:.3f} m or more, for a position {distance + tolerance:.3f} m away or less, or set nearest: true"
        )


def _goal(
    graph: MotionGraph,
    meshes: Dataset[MeshSequence],
    spots: list[Spot],
    position: tuple[float, ...],
    heading: float | None,
    weights: tuple[float, float],
) -> Goal:
    """Where to end, in coordinates of the first take."""
    if len(position) not in (0, 2):
        raise ValueError(f"{_WHO}: position must be x, z in metres, or empty, got {len(position)} numbers")
    takes = list(map(str, np.asarray(graph.takes)))
    first, last = (
        np.asarray(meshes[takes[spot.take]].vertices[spot.frame]) for spot in (spots[0], spots[-1])
    )
    start, end = (points[:, [0, 2]].mean(axis=0, dtype=np.float64) for points in (first, last))
    place = start + np.array(position) if position else np.full(2, np.nan)
    turned = align(first, last)[0].yaw
    return Goal(place, np.nan if heading is None else heading + turned, *weights, end)
