"""Walks between key frames for any target of distance and time: a table filled once, then searched."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.walk_moves import Moves, Targets, Walk
from reperform.nodes.kernels.walk_search import cheapest_walk
from reperform.nodes.kernels.walk_table import WalkTable, fill_table

# Finest cells of distance worth having, m.
_FINEST = 5e-4
# Above the table's bound, what walks may cost at first.
_STEP = 2e-3
# What a tolerance missed costs beside transitions, where the nearest walk is looked for.
_MISSED = 1e3


class Answer(NamedTuple):
    """The cheapest walk within the tolerances; None where none was found, and whether that is proved."""

    walk: Walk | None
    proved: bool


@dataclass(frozen=True)
class PreparedSearch:
    """Walks from the first key frame to the last, up to `horizon` steps and `reach` m: filled once, then asked.

    The table bounds from below what remains to be paid, by place, steps and distance; a search led by it finds the
    cheapest walk and proves it, within an effort.
    """

    moves: Moves
    free: bool
    table: WalkTable

    @classmethod
    def fill(
        cls, moves: Moves, horizon: int, reach: float, weight: float, cells: int = 50_000_000
    ) -> PreparedSearch:
        """Fill the table; reach inf leaves distance free; weight: the usual cost of a metre; cells bound the memory."""
        free = not np.isfinite(reach)
        if free:
            still = np.zeros(len(moves.length))
            moves = moves._replace(start=still, end=still)
            return cls(moves, True, fill_table(moves._replace(length=still), horizon, 0.0, 1.0, 1.0))
        states = len(moves.first) - 1
        cell = max(_FINEST, reach * states * (horizon + 1) / cells)
        return cls(moves, False, fill_table(moves, horizon, reach, cell, weight))

    def ask(self, targets: Targets, effort: int = 30_000) -> Answer:
        """The cheapest walk within the tolerances and the table, with a bound that no such walk beats.

            cost = sum of transition costs + distance_weight |d - d_V| + steps_weight |t - t_V|

        effort: labels that the proof may take; then `bound` may be less than the cost.
        """
        return self._searched(targets, targets, _STEP, effort)

    def nearest(self, targets: Targets, effort: int = 30_000) -> Walk | None:
        """The walk with least |d - d_V| / tolerance + |t - t_V| / tolerance; its bound is nan."""
        missed = Targets(
            targets.distance, targets.steps, _MISSED / targets.distance_tolerance,
            _MISSED / targets.steps_tolerance, np.inf, np.inf,
        )  # fmt: skip
        walk = self._searched(missed, targets, 1.0, effort).walk
        return None if walk is None else walk._replace(bound=np.nan)

    def _searched(self, wanted: Targets, targets: Targets, step: float, effort: int) -> Answer:
        """The walk found for `wanted`, priced by `targets`."""
        numbers = Targets(*(float(number) for number in wanted))
        moves = self.moves
        if self.free:
            numbers = numbers._replace(distance=np.nan)
            moves = moves._replace(length=np.zeros(len(moves.length)))
        edges, _, bound, proved = cheapest_walk(moves, self.table, numbers, step, effort)
        if len(edges) == 0:
            return Answer(None, bool(proved))
        taken = self.moves.passage[edges]
        distance, steps = float(self.moves.length[edges].sum()), int(self.moves.steps[edges].sum())
        cost = float(self.moves.cost[edges].astype(np.float64).sum()) + float(targets.miss(distance, steps))
        walk = Walk(tuple(taken[taken >= 0].tolist()), distance, steps, cost, min(float(bound), cost))
        return Answer(walk, True)
