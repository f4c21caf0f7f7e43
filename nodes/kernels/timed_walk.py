"""The cheapest walk that shows given poses at given times, by dynamic programming over frames and time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from reperform.nodes.kernels.graph_moves import Moves


class TimedWalk(NamedTuple):
    """Moves in order, the frame at which each pose is shown (counted from the first pose), and what it costs."""

    chain: tuple[int, ...]
    shown: tuple[int, ...]
    cost: float


class Unreachable(NamedTuple):
    """The pose that cannot be shown in time, and when the walk could show it instead, frames from the first pose."""

    pose: int
    instead: tuple[int, ...]


def timed_walk(
    moves: Moves, poses: np.ndarray, times: np.ndarray, tolerance: int, frame_weight: float
) -> TimedWalk | Unreachable:
    """The walk of least cost through poses (M,), frames of the graph, at times (M,), whole frames from 0 on.

        cost = sum of the moves' costs + frame_weight sum_k |shown_k - times_k|,   |shown_k - times_k| <= tolerance

    The minimum is over all walks: exact, since the best way to (frame, time) does not depend on what follows.

    Source: Boukhayma and Boyer 2015, 3DV (002 section 4, pose/time constraints). Departure: dynamic programming in
    place of depth-first search of one pair of poses after the other; what is late at one pose may be made up for.
    """
    graph = (moves.leaving, moves.target, moves.steps, moves.cost)
    count = len(moves.leaving) - 1
    arrived = {0: 0.0}
    stages = []
    for k in range(1, len(poses)):
        begin = min(arrived)
        entry = np.full(max(arrived) - begin + 1, np.inf)
        for t, cost in arrived.items():
            entry[t - begin] = cost
        last = int(times[k]) + tolerance - begin
        table, back = _fill(*graph, entry, int(poses[k - 1]), count, max(last, 0))
        row = table[:, poses[k]]
        wanted = {
            t: float(row[t - begin]) + frame_weight * abs(t - int(times[k]))
            for t in range(max(int(times[k]) - tolerance, begin), begin + last + 1)
            if np.isfinite(row[t - begin])
        }
        stages.append((begin, back))
        if not wanted:
            return Unreachable(
                k, _instead(graph, entry, int(poses[k - 1]), int(poses[k]), count, begin, int(times[k]))
            )
        arrived = wanted
    shown = min(arrived, key=lambda t: (arrived[t], t))
    cost, when, chain = arrived[shown], [shown], []
    for k in range(len(poses) - 1, 0, -1):
        begin, back = stages[k - 1]
        shown, part = _trace(back, moves, int(poses[k]), shown - begin)
        shown += begin
        when.append(shown)
        chain += part
    return TimedWalk(tuple(reversed(chain)), tuple(reversed(when)), cost)


def _instead(
    graph: tuple[np.ndarray, ...],
    entry: np.ndarray,
    source: int,
    target: int,
    count: int,
    begin: int,
    wanted: int,
) -> tuple[int, ...]:
    """Times before and after the wanted one at which the target can be shown, as far as twice the time asked."""
    table, _ = _fill(*graph, entry, source, count, 2 * max(wanted - begin, 1) + count)
    at = np.flatnonzero(np.isfinite(table[:, target])) + begin
    return tuple(int(part[k]) for part, k in ((at[at < wanted], -1), (at[at > wanted], 0)) if len(part))


def _trace(back: np.ndarray, moves: Moves, node: int, time: int) -> tuple[int, list[int]]:
    """Moves into a cell, last first, and the time at which the walk sets out."""
    chain: list[int] = []
    while back[time, node] >= 0:
        move = int(back[time, node])
        chain.append(move)
        time -= int(moves.steps[move])
        node = int(moves.source[move])
    return time, chain


@njit(cache=True, nogil=True)
def _fill(
    leaving: np.ndarray,
    target: np.ndarray,
    steps: np.ndarray,
    cost: np.ndarray,
    entry: np.ndarray,
    source: int,
    count: int,
    horizon: int,
) -> tuple[np.ndarray, np.ndarray]:
    """Least cost (horizon + 1, N) of being at a frame at a time, and the move that got there (-1: none)."""
    table = np.full((horizon + 1, count), np.inf)
    back = np.full((horizon + 1, count), -1, np.int32)
    for t in range(horizon + 1):
        # setting out afresh wins where it is cheaper than coming round again
        if t < len(entry) and entry[t] < table[t, source]:
            table[t, source] = entry[t]
            back[t, source] = -1
        for i in range(count):
            here = table[t, i]
            if here == np.inf:
                continue
            for e in range(leaving[i], leaving[i + 1]):
                then = t + steps[e]
                if then <= horizon and here + cost[e] < table[then, target[e]]:
                    table[then, target[e]] = here + cost[e]
                    back[then, target[e]] = e
    return table, back
