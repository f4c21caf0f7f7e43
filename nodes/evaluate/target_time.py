"""What a target of key-framed synthesis takes."""

from __future__ import annotations

from contextlib import suppress
from time import thread_time
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.prepared_search import PreparedSearch
from reperform.nodes.kernels.walk_moves import Moves, Targets
from reperform.nodes.kernels.walk_programme import enumerate_pieces, solve_programme
from reperform.nodes.product import Dataset
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph
from reperform.nodes.synthesis.key_frame_parameters import (
    DistanceTolerance,
    DurationTolerance,
    Keys,
)
from reperform.nodes.synthesis.key_frame_targets import asked_targets, moves_between

_WHO = "evaluate.target_time"
_WEIGHTS = 10 / 3, 2.5
# Beyond the greatest targets.
_FURTHER, _LATER = 2.0, 4.0


@node(over="dataset", memory=2.0, volatile=True)
def target_time(
    graph: MotionGraph,
    meshes: Dataset[MeshSequence],
    *,
    keys: Keys,
    distances: Annotated[tuple[float, ...], Param("m", about="targets")] = (4.0, 8.0, 12.0, 16.0, 20.0),
    durations: Annotated[tuple[float, ...], Param("s", about="targets")] = (8.0, 16.0, 24.0, 32.0, 40.0),
    distance_tolerance: DistanceTolerance = 0.05,
    duration_tolerance: DurationTolerance = 0.08,
    programmes: Annotated[int, Param("1", 0, 1000, "targets that the integer programme solves too")] = 2,
    cells: Annotated[float, Param("1e6", 1.0, 4000.0, "size of the table")] = 150.0,
    patience: Annotated[float, Param("s", 0.1, 1e5, "after which an integer programme is cut off")] = 20.0,
    walks: Annotated[int, Param("1", 1, 10**6, "loop-free walks at most")] = 5000,
    loops: Annotated[int, Param("1", 1, 10**6, "loops at most")] = 5000,
) -> Measures:
    """Seconds of processor per target, one row per key-frame sequence; nan where nothing was measured.

    `prepare`: laying out and filling the table; `target`, `target max`: mean and greatest time of one answer
    (infeasible ones with their nearest), the least of three runs each; `enumerate`: the walks and loops of the
    integer programmes. Of the targets that these solve too, spread evenly over all: `proved`: the share on which the
    programme came to its optimum, or to the proof that there is none, within `patience`; and on these alone
    `programme`: mean seconds of a programme; `speedup`: over those of the search; `cost difference`: the greatest
    of search - programme, inf where only one of both finds a motion.

    Raises ValueError where a key frame does not exist, key frames cannot be joined, or pieces are too many.
    Source: 000 table III (seconds per target) and section 5.1.2 (the integer programme).
    """
    rate, tolerances = float(graph.fps), (distance_tolerance, duration_tolerance)
    grid = [
        asked_targets(metres, seconds, _WEIGHTS, tolerances, rate, _WHO)
        for metres in distances
        for seconds in durations
    ]
    horizon, reach = int(np.ceil((max(durations) + _LATER) * rate)), max(distances) + _FURTHER
    rows = []
    for sequence in keys:
        begun = thread_time()
        moves, _ = moves_between(graph, meshes, [key.strip() for key in sequence.split(">")], _WHO)
        search = PreparedSearch.fill(moves, horizon, reach, _WEIGHTS[0], int(cells * 1e6))
        prepared = thread_time() - begun
        seconds = np.min([[_timed(search, targets) for targets in grid] for _ in range(3)], axis=0)
        compared = _programmes(moves, search, grid, seconds, programmes, horizon, (walks, loops), patience)
        rows.append((prepared, seconds.mean(), seconds.max(), *compared))
    names = (
        "prepare",
        "target",
        "target max",
        "enumerate",
        "programme",
        "proved",
        "cost difference",
        "speedup",
    )
    return Measures(np.array(rows, np.float64), np.array(names), np.array(["s"] * 5 + ["1"] * 3))


def _timed(search: PreparedSearch, targets: Targets) -> float:
    begun = thread_time()
    if search.ask(targets).walk is None:
        search.nearest(targets)
    return thread_time() - begun


def _programmes(
    moves: Moves,
    search: PreparedSearch,
    grid: list[Targets],
    searched: np.ndarray,
    count: int,
    horizon: int,
    limits: tuple[int, int],
    patience: float,
) -> tuple[float, float, float, float, float]:
    """Seconds to enumerate, and `programme`, `proved`, `cost difference`, `speedup`; searched: seconds per target."""
    if count == 0:
        return np.nan, np.nan, np.nan, np.nan, np.nan
    begun = thread_time()
    pieces = enumerate_pieces(moves, horizon, *limits)
    enumerated = thread_time() - begun
    count = min(count, len(grid))
    chosen = ((np.arange(count) + 0.5) * len(grid) / count).astype(int).tolist()
    proved: list[tuple[float, float, float]] = []
    for k in chosen:
        begun = thread_time()
        with suppress(TimeoutError):
            other = solve_programme(moves, pieces, grid[k], patience)
            seconds, walk = thread_time() - begun, search.ask(grid[k]).walk
            agree = 0.0 if walk is None and other is None else np.inf
            difference = agree if walk is None or other is None else walk.cost - other.cost
            proved.append((seconds, float(searched[k]), difference))
    if not proved:
        return enumerated, np.nan, 0.0, np.nan, np.nan
    programme, own, differences = np.array(proved).T
    speedup = float(programme.mean() / own.mean())
    return enumerated, float(programme.mean()), len(proved) / len(chosen), float(differences.max()), speedup
