"""Whether key-framed synthesis finds what trying every walk finds."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.every_walk import every_walk, random_graph
from reperform.nodes.kernels.prepared_search import PreparedSearch
from reperform.nodes.kernels.walk_moves import Spot, Targets, lay_out
from reperform.nodes.products.measures import Measures

_HORIZON = 60
# Costs nearer than this are equal: transition costs are float32.
_EQUAL = 1e-6


@node(over="dataset")
def optimality_gap(
    *,
    graphs: Annotated[int, Param("1", 1, 1000, "random small graphs")] = 10,
    targets: Annotated[int, Param("1", 1, 1000, "random targets per graph")] = 40,
    seed: Annotated[int, Param("1", 0, 2**31 - 1, "seed of graphs and targets")] = 0,
) -> Measures:
    """The prepared search against every walk of up to 60 steps through random graphs of three takes.

    One row per target. `gap`: cost found - least cost of all walks within the tolerances (0.15 m, 5 steps), where one
    is; differences under 1e-6 are 0. `wrong`: 1 where search and trial disagree whether there is one, or the bound is
    above the least cost.

    Source: definition (exhaustive enumeration).
    """
    rows = []
    random = np.random.default_rng(seed)
    for number in range(graphs):
        graph, keys = random_graph(seed + number), [Spot(0, 1), Spot(2, 17)]
        every, moves = every_walk(graph, keys, _HORIZON), lay_out(*graph, keys)
        if not moves.reachable:
            rows += [(np.nan, float(len(every.steps) > 0))] * targets
            continue
        search = PreparedSearch.fill(moves, _HORIZON, 6.0, 10 / 3, 2_000_000)
        for _ in range(targets):
            asked = Targets(random.uniform(0.5, 3.0), float(random.integers(15, 55)), 10 / 3, 0.1, 0.15, 5.0)
            rows.append(_row(search, asked, every.least(asked)))
    return Measures(np.array(rows, np.float64), np.array(["gap", "wrong"]), np.array(["1", "1"]))


def _row(search: PreparedSearch, asked: Targets, least: float) -> tuple[float, float]:
    walk = search.ask(asked).walk
    if walk is None:
        return np.nan, float(np.isfinite(least))
    gap = walk.cost - least
    return (0.0 if abs(gap) < _EQUAL else gap), float(not walk.bound <= least + _EQUAL)
