"""What a target of key-framed synthesis takes."""

from __future__ import annotations

from contextlib import suppress
from time import perf_counter
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
from reperform.nodes.synthesis.key_frame_targets import asked_targets, moves_between

_WHO = "evaluate.target_time"
_TOLERANCES = 0.05, 0.08
_WEIGHTS = 10 / 3, 2.5
# Beyond the greatest targets.
_FURTHER, _LATER = 2.0, 4.0


@node(over="dataset", memory=2.0, volatile=True)
def target_time(
    graph: MotionGraph,
    meshes: Dataset[MeshSequence],
    *,
    keys: Annotated[tuple[str, ...], Param(about="key-frame sequences, each TAKE:FRAME > TAKE:FRAME > ...")],
    distances: Annotated[tuple[float, ...], Param("m", about="targets")] = (4.0, 8.0, 12.0, 16.0, 20.0),
    durations: Annotated[tuple[float, ...], Param("s", about="targets")] = (8.0, 16.0, 24.0, 32.0, 40.0),
    programmes: Annotated[int, Param("1", 0, 1000, "targets that the integer programme solves too")] = 2,
    cells: Annotated[float, Param("1e6", 1.0, 4000.0, "size of the table")] = 150.0,
    patience: Annotated[float, Param("s", 0.1, 1e5, "after which an integer programme is cut off")] = 20.0,
    walks: Annotated[int, Param("1", 1, 10**6, "loop-free walks at most")] = 5000,
    loops: Annotated[int, Param("1", 1, 10**6, "loops at most")] = 5000,
) -> Measures:
    """Seconds per target, one row per key-frame sequence; nan where nothing was measured.

    `prepare`: laying out and filling the table; `target`, `target max`: mean and greatest time of one answer
    (infeasible ones with their nearest), the least of three runs each; `programme`: mean of one integer
    programme in the same run, cut off after `patience` and then counted with that; `enumerate`: its walks and
    loops, beforehand; `speedup`: programme over target; `cost difference`: the greatest of search - programme.

    Raises ValueError where a key frame does not exist, key frames cannot be joined, or pieces are too many.
    Source: 000 table III (seconds per target) and section 5.1.2 (the integer programme).
    """
    rate = float(graph.fps)
    grid = [
        asked_targets(metres, seconds, _WEIGHTS, _TOLERANCES, rate, _WHO)
        for metres in distances
        for seconds in durations
    ]
    horizon, reach = int(np.ceil((max(durations) + _LATER) * rate)), max(distances) + _FURTHER
    rows = []
    for sequence in keys:
        begun = perf_counter()
        moves, _ = moves_between(graph, meshes, [key.strip() for key in sequence.split(">")], _WHO)
        search = PreparedSearch.fill(moves, horizon, reach, _WEIGHTS[0], int(cells * 1e6))
        prepared = perf_counter() - begun
        seconds = np.min([[_timed(search, targets) for targets in grid] for _ in range(3)], axis=0)
        programme = _programme(moves, search, grid, programmes, horizon, (walks, loops), patience)
        rows.append((prepared, seconds.mean(), seconds.max(), *programme, programme[1] / seconds.mean()))
    names = ("prepare", "target", "target max", "enumerate", "programme", "cost difference", "speedup")
    return Measures(np.array(rows, np.float64), np.array(names), np.array(["s"] * 5 + ["1", "1"]))


def _timed(search: PreparedSearch, targets: Targets) -> float:
    begun = perf_counter()
    if search.ask(targets).walk is None:
        search.nearest(targets)
    return perf_counter() - begun


def _programme(
    moves: Moves,
    search: PreparedSearch,
    grid: list[Targets],
    count: int,
    horizon: int,
    limits: tuple[int, int],
    patience: float,
) -> tuple[float, float, float]:
    """Seconds to enumerate, mean seconds of a programme, greatest difference of cost to the search."""
    if count == 0:
        return np.nan, np.nan, np.nan
    begun = perf_counter()
    pieces = enumerate_pieces(moves, horizon, *limits)
    enumerated = perf_counter() - begun
    seconds: list[float] = []
    differences: list[float] = []
    for k in np.unique(np.linspace(0, len(grid) - 1, count + 2)[1:-1].astype(int)).tolist():
        begun = perf_counter()
        other = None
        with suppress(TimeoutError):
            other = solve_programme(moves, pieces, grid[k], patience)
        seconds.append(perf_counter() - begun)
        walk = search.ask(grid[k]).walk
        if other is not None and walk is not None:
            differences.append(walk.cost - other.cost)
    return enumerated, float(np.mean(seconds)), max(differences, default=np.nan)
