"""A curve to be followed through a pose graph: what may be played where, and where walks may set out."""

from __future__ import annotations

import fnmatch
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.curve_samples import curve_samples
from reperform.nodes.kernels.curve_walk import Curve, Starts, Trail, remaining_cost, trail
from reperform.nodes.kernels.ground_plane import rotate_ground
from reperform.nodes.kernels.stretch_action import read_action
from reperform.nodes.synthesis.pose_graph_walk import Graph

# Curves are sampled this finely, and go on straight so far that no move runs off them, m.
_STEP, _BEYOND = 0.01, 4.0
# A body that gets this far within the first half second knows its direction, m; one that does not tries all.
_MOVING, _LOOK, _TURNS = 0.08, 0.5, 36


class CurveProblem(NamedTuple):
    """All that a search along a curve asks for."""

    curve: Curve
    starts: Starts
    trail: Trail
    # lower bound of the cost that remains, by stretch of the curve and frame
    rest: np.ndarray

    @property
    def bound(self) -> float:
        """A lower bound of the cost of any walk; inf where there is none."""
        return float(self.rest[0, self.starts.frame].min())


def curve_problem(
    graph: Graph,
    points: Sequence[Sequence[float]],
    actions: Sequence[str],
    start: str,
    distance_weight: float,
    who: str,
) -> CurveProblem:
    """Points (x, z) of a curve, m, actions FROM-TO TAKE on it and a first pose TAKE:FRAME (empty: any), made ready.

    Raises ValueError where they cannot be read, no take has an action's name, or no walk gets to the end with what is
    allowed.
    """
    way = _curve(points, actions, graph.takes, who)
    starts = _starts(graph, way, start, who)
    problem = CurveProblem(
        way, starts, trail(graph.moves, way, distance_weight), remaining_cost(graph.moves, way)
    )
    if not np.isfinite(problem.bound):
        raise ValueError(
            f"{who}: no walk gets to the end of the {way.length:.2f} m with what is allowed: "
            f"lengthen the stretches of actions or leave gaps between them"
        )
    return problem


def _curve(
    points: Sequence[Sequence[float]], actions: Sequence[str], takes: Sequence[str], who: str
) -> Curve:
    try:
        samples, length = curve_samples(np.array(points, np.float64).reshape(-1, 2), _STEP, _BEYOND)
    except ValueError as error:
        raise ValueError(f"{who}: {error}") from None
    chosen = np.zeros((len(takes), len(samples)), bool)
    ruled = np.zeros(len(samples), bool)
    for text in actions:
        first, last, name = read_action(text, who)
        found = [k for k, take in enumerate(takes) if fnmatch.fnmatchcase(take, name)]
        if not found:
            raise ValueError(
                f"{who}: action {text!r}: no take is called {name}, there are {', '.join(takes)}"
            )
        stretch = slice(round(first / _STEP), round(last / _STEP) + 1)
        chosen[found, stretch] = True
        ruled[stretch] = True
    return Curve(samples, _STEP, length, chosen | ~ruled)


def _starts(graph: Graph, curve: Curve, start: str, who: str) -> Starts:
    """Placements that put the body of each possible first pose on the curve's start, on its way along it."""
    count = len(graph.moves.leaving) - 1
    frames = [graph.pose(start, who)] if start else range(count)
    begin = np.concatenate([[0], np.cumsum(graph.frames)])
    along = curve.points[1] - curve.points[0]
    wanted = np.arctan2(along[0], along[1])
    look = max(1, round(_LOOK * float(graph.fps)))
    rows: list[tuple[int, float]] = []
    for frame in frames:
        take = int(np.searchsorted(begin, frame, "right")) - 1
        if not curve.allowed[take, 0] or frame == begin[take + 1] - 1:
            continue
        way = _middle(graph, min(frame + look, int(begin[take + 1]) - 1)) - _middle(graph, frame)
        if np.linalg.norm(way) > _MOVING:
            rows.append((frame, float(wanted - np.arctan2(way[0], way[1]))))
        elif start:
            rows += [(frame, 2 * np.pi * k / _TURNS) for k in range(_TURNS)]
    if not rows:
        raise ValueError(
            f"{who}: no walk can set out: {start or 'no take'} is allowed at the curve's start, or moves on"
        )
    number, yaw = np.array([row[0] for row in rows]), np.array([row[1] for row in rows])
    offset = np.stack([curve.points[0] - rotate_ground(_middle(graph, f), y) for f, y in rows])
    return Starts(number, yaw, offset, np.tile(curve.points[0], (len(rows), 1)))


def _middle(graph: Graph, frame: int) -> np.ndarray:
    """Where the body stands in a captured frame, (2,), m."""
    moves = graph.moves
    if moves.leaving[frame] < moves.leaving[frame + 1]:
        row = moves.first[moves.leaving[frame]]
    else:
        row = moves.first[1:][moves.target == frame][0] - 1
    return np.asarray(moves.middle[row, [0, 2]])
