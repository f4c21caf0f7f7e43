"""A table of all walks between key frames over time and distance: filled once, then any target is looked up."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.walk_moves import Moves, Targets, Walk
from reperform.nodes.kernels.walk_table import NONE, WalkTable, fill, follow, look_up, nearest, try_all

# Finest step of distance worth having, m.
_FINEST = 5e-5
# Costs nearer than this are equal.
_EQUAL = 1e-9


class Answer(NamedTuple):
    """The cheapest walk within the tolerances; None where none was found, and whether that is proved."""

    walk: Walk | None
    proved: bool


@dataclass(frozen=True)
class PreparedSearch:
    """Walks from the first key frame to the last, up to `horizon` steps and `reach` m: filled once, then asked.

    Distances are rounded to whole quanta along each move; each move's error is known, so that every answer
    comes with a lower bound that no walk can beat, and is improved by trying all walks of promising cells,
    up to `effort` of them.
    """

    moves: Moves
    units: np.ndarray
    quantum: float
    weight: float
    table: WalkTable

    @classmethod
    def fill(
        cls, moves: Moves, horizon: int, reach: float, weight: float, cells: int = 100_000_000
    ) -> PreparedSearch:
        """Fill the table; reach inf leaves distance free; weight is the cost of a metre; cells bound the memory."""
        states = len(moves.first) - 1
        if int(np.diff(moves.first).max(initial=0)) >= NONE:
            raise ValueError(f"key frames: at most {NONE - 1} transitions may leave one frame: keep fewer")
        free = not np.isfinite(reach)
        quantum = 1.0 if free else max(_FINEST, reach * states * (horizon + 1) / cells)
        units = np.zeros(len(moves.length), np.int64) if free else _units(moves, quantum)
        error = np.zeros(len(units)) if free else np.abs(moves.length - units * quantum)
        width = 1 if free else int(reach / quantum) + 2
        keep = int(moves.steps.max(initial=0)) + 1
        table = WalkTable(*fill(moves, units, error, weight, horizon, width, keep))
        return cls(moves, units, quantum, 0.0 if free else weight, table)

    def ask(self, targets: Targets, effort: int = 10_000) -> Answer:
        """The cheapest walk within the tolerances and the table, with a bound that no such walk beats.

            cost = sum of transition costs + distance_weight |d - d_V| + steps_weight |t - t_V|

        Raises ValueError where targets weigh distance otherwise than the table was filled for.
        """
        if np.isfinite(targets.distance) and targets.distance_weight > self.weight:
            raise ValueError("key frames: the table was filled for a lesser weight of distance: fill it anew")
        steps, cell, cost, bound, possible = look_up(self.table, self.quantum, _numbers(targets))
        if not possible:
            return Answer(None, True)
        walk = self._trace(steps, cell, targets) if steps >= 0 else None
        cost = np.inf if walk is None else walk.cost
        done = False
        if cost - bound > _EQUAL and effort > 0:
            found, done = self._refined(targets, cost, effort)
            walk = found if found is not None else walk
        if walk is None:
            return Answer(None, done)
        return Answer(walk._replace(bound=walk.cost if done else min(bound, walk.cost)), True)

    def nearest(self, targets: Targets) -> Walk | None:
        """The walk with least |d - d_V| / tolerance + |t - t_V| / tolerance; its bound is nan."""
        steps, cell = nearest(self.table, self.quantum, _numbers(targets))
        return self._trace(steps, cell, targets) if steps >= 0 else None

    def _trace(self, steps: int, cell: int, targets: Targets) -> Walk:
        edges = follow(self.moves, self.units, self.table.choice, steps, cell)
        return self._walk(edges, targets)

    def _walk(self, edges: np.ndarray, targets: Targets) -> Walk:
        taken = self.moves.passage[edges]
        distance, steps = float(self.moves.length[edges].sum()), int(self.moves.steps[edges].sum())
        cost = float(self.moves.cost[edges].astype(np.float64).sum()) + float(targets.miss(distance, steps))
        return Walk(tuple(taken[taken >= 0].tolist()), distance, steps, cost, np.nan)

    def _refined(self, targets: Targets, cost: float, effort: int) -> tuple[Walk | None, bool]:
        """A cheaper walk, if trying all walks of the promising cells meets one; whether all were tried."""
        edges, done = try_all(
            self.moves, self.units, self.table, self.quantum, _numbers(targets), cost, effort
        )
        return (self._walk(edges, targets) if len(edges) else None), bool(done)


def _numbers(targets: Targets) -> Targets:
    """One machine type, so that the loops are compiled once."""
    return Targets(*(float(number) for number in targets))


def _units(moves: Moves, quantum: float) -> np.ndarray:
    """Lengths in whole quanta.

    What is rounded off at the start and end of moves along one take cancels out, so that a walk is off
    by at most one quantum per transition and one for its ends.
    """
    start, end = moves.start / quantum, moves.end / quantum
    exact = moves.length / quantum + (np.rint(end) - end) - (np.rint(start) - start)
    return np.maximum(np.rint(exact), 0).astype(np.int64)
