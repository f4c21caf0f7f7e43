"""The best walk through a motion graph between key frames, by dynamic programming over distance and time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import njit

from reperform.nodes.kernels.path_frames import Passage, arc_length, passage_track

# Cells of the table at most (4 bytes each): the step of distance is as fine as they allow.
_CELLS = 100_000_000
# Finest step of distance worth having, m.
_FINEST = 5e-5
# Best cells whose walks are measured exactly.
_MEASURED = 256


class Spot(NamedTuple):
    """A captured frame of a take."""

    take: int
    frame: int


class Targets(NamedTuple):
    """What is asked of a walk: distance (m) and steps (frames - 1), nan where free; weights per unit."""

    distance: float
    steps: float
    distance_weight: float
    steps_weight: float
    distance_tolerance: float
    steps_tolerance: float

    def miss(self, distance: float | np.ndarray, steps: float | np.ndarray) -> np.ndarray:
        """The soft cost of a distance and a number of steps."""
        far = np.nan_to_num(np.abs(distance - self.distance)) * self.distance_weight
        return np.asarray(far + np.nan_to_num(np.abs(steps - self.steps)) * self.steps_weight)


class Walk(NamedTuple):
    """A walk found: its transitions, what it covers and costs, a proved lower bound of any walk's cost."""

    passages: tuple[int, ...]
    distance: float
    steps: int
    cost: float
    bound: float


class _Edges(NamedTuple):
    """Moves between states, sorted by the state they leave; `following` is -1 where the walk ends there."""

    first: np.ndarray
    following: np.ndarray
    steps: np.ndarray
    length: np.ndarray
    cost: np.ndarray
    passage: np.ndarray
    # arc length from the take's first frame to where a move starts and ends, m
    start: np.ndarray
    end: np.ndarray


@dataclass(frozen=True)
class KeyFrameSearch:
    """Walks from one key frame to another through others, in order: built once per key frames, then asked.

    A state is a place where a take can be left, with the number of key frames met so far; state 0 is the
    start. Moves leave it by one of its transitions or stay in the take; both lead to the next such place or
    to the end.
    """

    edges: _Edges
    # least steps of a move that takes a transition
    quickest: int

    @classmethod
    def build(
        cls,
        passages: Sequence[Passage],
        costs: np.ndarray,
        tracks: Sequence[np.ndarray],
        keys: Sequence[Spot],
    ) -> KeyFrameSearch:
        """Lay out the states between key frames.

        passages, costs: the transitions; tracks: centroid on the ground per take (frames, 2), m; keys: at
        least the first and the last key frame.
        """
        return _Layout(passages, costs, tracks, keys).search()

    @property
    def reachable(self) -> bool:
        """Whether any walk at all meets all key frames in order."""
        return bool((self.edges.following == -1).any())

    def best(self, targets: Targets, horizon: int, reach: float) -> Walk | None:
        """The cheapest walk within the tolerances, among all of at most `horizon` steps and `reach` metres.

            cost = sum of transition costs + distance_weight |d - d_V| + steps_weight |t - t_V|

        None where no walk is within the tolerances.
        """
        return self._least(targets, horizon, reach, targets)

    def nearest(self, targets: Targets, horizon: int, reach: float) -> Walk | None:
        """The walk nearest to the targets, in units of their tolerances; None where none ends in time."""
        per_metre = 1e3 / targets.distance_tolerance
        per_step = 1e3 / targets.steps_tolerance
        free = Targets(targets.distance, targets.steps, per_metre, per_step, np.inf, np.inf)
        return self._least(free, horizon, reach, targets)

    def _least(self, chosen: Targets, horizon: int, reach: float, priced: Targets) -> Walk | None:
        states = len(self.edges.first) - 1
        free = np.isnan(chosen.distance)
        quantum = max(_FINEST, reach * states * (horizon + 1) / _CELLS) if not free else 1e30
        width = int(reach / quantum) + 2 if not free else 1
        units = np.zeros(len(self.edges.length), np.int64) if free else _units(self.edges, quantum)
        table, low, high = _fill(*self.edges[:3], units, self.edges.cost, states, horizon, width)
        steps, cells = _ends(low, high)
        if len(steps) == 0:
            return None
        soft = table[0, steps, cells].astype(np.float64)
        slack = 0.0 if free else quantum * (horizon // self.quickest + 1)
        distance = np.full(len(cells), np.nan) if free else cells * quantum
        relaxed = _relaxed(chosen, distance, steps, slack)
        within = np.isfinite(soft + relaxed)
        if not within.any():
            return None
        estimate = soft + chosen.miss(distance, steps)
        bound = float((soft + relaxed)[within].min())
        order = np.flatnonzero(within)
        order = order[np.argsort(estimate[order], kind="stable")][:_MEASURED]
        best: Walk | None = None
        least = np.inf
        for i in order:
            if estimate[i] - slack * chosen.distance_weight > least:
                break
            walk = self._trace(table, low, high, units, int(steps[i]), int(cells[i]), priced, bound)
            value = float(soft[i] + chosen.miss(walk.distance, walk.steps))
            if value < least and np.isfinite(_relaxed(chosen, walk.distance, walk.steps, 0.0)):
                best, least = walk, value
        if best is not None:
            best = best._replace(bound=min(best.bound, best.cost))
        return best

    def _trace(
        self,
        table: np.ndarray,
        low: np.ndarray,
        high: np.ndarray,
        units: np.ndarray,
        steps: int,
        cell: int,
        targets: Targets,
        bound: float,
    ) -> Walk:
        """The walk behind a cell of the start, measured exactly."""
        state, passages, distance, cost, total = 0, [], 0.0, 0.0, steps
        while state >= 0:
            chosen = -1
            for e in range(self.edges.first[state], self.edges.first[state + 1]):
                rest, place, follow = steps - self.edges.steps[e], cell - units[e], self.edges.following[e]
                if follow < 0:
                    fits = rest == 0 and place == 0
                    value = self.edges.cost[e]
                else:
                    fits = rest >= 0 and low[follow, max(rest, 0)] <= place <= high[follow, max(rest, 0)]
                    value = self.edges.cost[e] + table[follow, rest, place] if fits else np.float32(np.inf)
                if fits and value == table[state, steps, cell]:
                    chosen = e
                    break
            e = chosen
            if self.edges.passage[e] >= 0:
                passages.append(int(self.edges.passage[e]))
            distance += float(self.edges.length[e])
            cost += float(self.edges.cost[e])
            steps, cell, state = (
                int(steps - self.edges.steps[e]),
                int(cell - units[e]),
                int(self.edges.following[e]),
            )
        return Walk(tuple(passages), distance, total, cost + float(targets.miss(distance, total)), bound)


def _units(edges: _Edges, quantum: float) -> np.ndarray:
    """Lengths in whole quanta.

    What is rounded off at the start and end of moves along one take cancels out, so that a walk is off
    by at most one quantum per transition and one for its ends.
    """
    start, end = edges.start / quantum, edges.end / quantum
    exact = edges.length / quantum + (np.rint(end) - end) - (np.rint(start) - start)
    return np.maximum(np.rint(exact), 0).astype(np.int64)


def _ends(low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """All (steps, cell) in which the start has a walk to the end, by its bands."""
    counts = np.maximum(high[0] - low[0] + 1, 0)
    steps = np.repeat(np.arange(len(counts)), counts)
    cells = (
        np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts) + np.repeat(low[0], counts)
    )
    return steps, cells


def _relaxed(
    targets: Targets, distance: np.ndarray | float, steps: np.ndarray | int, slack: float
) -> np.ndarray:
    """The soft cost when the distance may be off by `slack`; inf outside the tolerances."""
    far = np.maximum(np.nan_to_num(np.abs(distance - targets.distance)) - slack, 0.0)
    late = np.nan_to_num(np.abs(np.asarray(steps) - targets.steps))
    outside = (far > targets.distance_tolerance + 1e-9) | (late > targets.steps_tolerance + 1e-6)
    return np.where(outside, np.inf, far * targets.distance_weight + late * targets.steps_weight)


# following state, steps, length, cost, transition, arc length where it starts and where it ends
_Move = tuple[int, int, float, float, int, float, float]


class _Layout:
    """Builds the states and moves of a search."""

    def __init__(
        self,
        passages: Sequence[Passage],
        costs: np.ndarray,
        tracks: Sequence[np.ndarray],
        keys: Sequence[Spot],
    ) -> None:
        self.passages, self.costs, self.keys = passages, costs, list(keys)
        self.length = [
            np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(track, axis=0), axis=1))])
            for track in tracks
        ]
        self.crossing = [arc_length(passage_track(passage, tracks)) for passage in passages]
        self.leaving: dict[tuple[int, int], list[int]] = {}
        for i, passage in enumerate(passages):
            self.leaving.setdefault((passage.source, passage.departure), []).append(i)
        self.stops = [sorted({d for t, d in self.leaving if t == take}) for take in range(len(tracks))]
        self.states: dict[tuple[int, int, int], int] = {}

    def search(self) -> KeyFrameSearch:
        """All states that the start reaches, and the moves between them."""
        start = self.keys[0]
        moves: list[list[_Move]] = [[]]
        begin = float(self.length[start.take][start.frame])
        pending = self._advance(moves[0], start.take, start.frame, True, 1, 0, 0.0, 0.0, -1, begin)
        while pending:
            take, stop, met = pending.pop()
            state = self.states[take, stop, met]
            while len(moves) <= state:
                moves.append([])
            here = float(self.length[take][stop])
            pending += self._advance(moves[state], take, stop, False, met, 0, 0.0, 0.0, -1, here)
            for i in self.leaving[take, stop]:
                passage = self.passages[i]
                pending += self._advance(
                    moves[state], passage.target, passage.arrival, True, met, 2 * passage.length,
                    self.crossing[i], float(self.costs[i]), i, here,
                )  # fmt: skip
        while len(moves) <= len(self.states):
            moves.append([])
        flat = [move for row in moves for move in row]
        columns = [np.array([move[k] for move in flat]) for k in range(7)]
        first = np.concatenate([[0], np.cumsum([len(row) for row in moves])]).astype(np.int64)
        edges = _Edges(
            first,
            columns[0].astype(np.int64),
            columns[1].astype(np.int64),
            columns[2].astype(np.float64),
            columns[3].astype(np.float32),
            columns[4].astype(np.int64),
            columns[5].astype(np.float64),
            columns[6].astype(np.float64),
        )
        by_passage = [2 * passage.length for passage in self.passages]
        return KeyFrameSearch(edges, min(by_passage, default=1))

    def _advance(
        self,
        moves: list[_Move],
        take: int,
        frame: int,
        inclusive: bool,
        met: int,
        steps: int,
        length: float,
        cost: float,
        passage: int,
        starts: float,
    ) -> list[tuple[int, int, int]]:
        """Add the moves on from a frame: to the take's next stop, and to the last key frame if met."""
        stop = next((d for d in self.stops[take] if d > frame or (inclusive and d == frame)), None)
        last = stop if stop is not None else len(self.length[take]) - 1
        place, at = frame, inclusive
        while met < len(self.keys) - 1 and self._meets(self.keys[met], take, place, at, last):
            place, at, met = self.keys[met].frame, True, met + 1
        if met == len(self.keys) - 1 and self._meets(self.keys[-1], take, place, at, last):
            moves.append(
                self._move(-1, take, frame, self.keys[-1].frame, steps, length, cost, passage, starts)
            )
        if stop is None:
            return []
        new = (take, stop, met) not in self.states
        state = self.states.setdefault((take, stop, met), len(self.states) + 1)
        moves.append(self._move(state, take, frame, stop, steps, length, cost, passage, starts))
        return [(take, stop, met)] if new else []

    @staticmethod
    def _meets(key: Spot, take: int, place: int, at: bool, last: int) -> bool:
        return key.take == take and (key.frame > place or (at and key.frame == place)) and key.frame <= last

    def _move(
        self,
        state: int,
        take: int,
        frame: int,
        to: int,
        steps: int,
        length: float,
        cost: float,
        passage: int,
        starts: float,
    ) -> _Move:
        along = float(self.length[take][to] - self.length[take][frame])
        return state, steps + to - frame, length + along, cost, passage, starts, float(self.length[take][to])


@njit(cache=True, nogil=True)
def _fill(
    first: np.ndarray,
    following: np.ndarray,
    steps: np.ndarray,
    units: np.ndarray,
    cost: np.ndarray,
    states: int,
    horizon: int,
    width: int,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Least cost from each state to the end in t steps and d cells, (states, horizon + 1, width) float32.

    Only cells low[s, t] .. high[s, t] hold values. Every move but those of the start takes at least one step,
    so filling by steps, the start last, meets what it needs.
    """
    table = np.empty((states, horizon + 1, width), np.float32)
    low = np.full((states, horizon + 1), width, np.int64)
    high = np.full((states, horizon + 1), -1, np.int64)
    for t in range(horizon + 1):
        for back in range(states):
            s = states - 1 - back
            for e in range(first[s], first[s + 1]):
                rest = t - steps[e]
                if rest < 0:
                    continue
                if following[e] < 0:
                    if rest == 0 and units[e] < width:
                        low[s, t] = min(low[s, t], units[e])
                        high[s, t] = max(high[s, t], units[e])
                elif high[following[e], rest] >= 0:
                    a = low[following[e], rest] + units[e]
                    b = min(high[following[e], rest] + units[e], width - 1)
                    if a <= b:
                        low[s, t] = min(low[s, t], a)
                        high[s, t] = max(high[s, t], b)
            if high[s, t] < 0:
                continue
            row = table[s, t]
            row[low[s, t] : high[s, t] + 1] = np.inf
            for e in range(first[s], first[s + 1]):
                rest = t - steps[e]
                if rest < 0:
                    continue
                if following[e] < 0:
                    if rest == 0 and units[e] < width:
                        row[units[e]] = min(row[units[e]], cost[e])
                elif high[following[e], rest] >= 0:
                    a = low[following[e], rest]
                    b = min(high[following[e], rest], width - 1 - units[e])
                    child = table[following[e], rest]
                    for d in range(a, b + 1):
                        value = cost[e] + child[d]
                        if value < row[d + units[e]]:
                            row[d + units[e]] = value
    return table, low, high
