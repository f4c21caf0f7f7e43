"""What a walk between key frames can do: places to leave a take, and the moves between them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.path_frames import Passage, arc_length, passage_track


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

    def off(self, distance: float, steps: float) -> tuple[float, float]:
        """How far off they are, in units of the tolerances; 0 where nothing is asked."""
        far, late = abs(distance - self.distance), abs(steps - self.steps)
        return (
            float(np.nan_to_num(far / self.distance_tolerance)),
            float(np.nan_to_num(late / self.steps_tolerance)),
        )


class Walk(NamedTuple):
    """A walk found: its transitions, what it covers and costs, a proved lower bound of any walk's cost."""

    passages: tuple[int, ...]
    distance: float
    steps: int
    cost: float
    bound: float


class Moves(NamedTuple):
    """Moves between states, sorted by the state they leave; `following` is -1 where the walk ends there.

    A state is a place where a take can be left, with the number of key frames met so far; state 0 is the
    start. Moves leave it by one of its transitions or stay in the take; both lead to the next such place or
    to the end.
    """

    first: np.ndarray
    following: np.ndarray
    steps: np.ndarray
    length: np.ndarray
    cost: np.ndarray
    passage: np.ndarray
    # arc length from the take's first frame to where a move starts and ends, m
    start: np.ndarray
    end: np.ndarray

    @property
    def reachable(self) -> bool:
        """Whether any walk at all meets all key frames in order."""
        return bool((self.following == -1).any())

    @property
    def origin(self) -> np.ndarray:
        """The state that each move leaves."""
        return np.repeat(np.arange(len(self.first) - 1), np.diff(self.first))


def least_steps(moves: Moves) -> np.ndarray:
    """Least steps from each state to the end; inf where there is no way."""
    origin, out = moves.origin, np.full(len(moves.first) - 1, np.inf)
    for _ in range(len(out)):
        after = np.where(moves.following < 0, 0.0, out[moves.following])
        np.minimum.at(out, origin, moves.steps + after)
    return out


def lay_out(
    passages: Sequence[Passage], costs: np.ndarray, tracks: Sequence[np.ndarray], keys: Sequence[Spot]
) -> Moves:
    """The states between key frames and the moves between them.

    passages, costs: the transitions; tracks: centroid on the ground per take (frames, 2), m; keys: at least
    the first and the last key frame.
    """
    return _Layout(passages, costs, tracks, keys).moves()


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

    def moves(self) -> Moves:
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
        return Moves(
            first,
            columns[0].astype(np.int64),
            columns[1].astype(np.int64),
            columns[2].astype(np.float64),
            columns[3].astype(np.float32),
            columns[4].astype(np.int64),
            columns[5].astype(np.float64),
            columns[6].astype(np.float64),
        )

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
