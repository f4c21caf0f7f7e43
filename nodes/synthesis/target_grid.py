"""The best motions for a whole grid of targets."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.prepared_search import PreparedSearch
from reperform.nodes.kernels.walk_moves import Targets
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph
from reperform.nodes.products.target_grid import TargetGrid
from reperform.nodes.synthesis.key_frame_parameters import (
    DistanceTolerance,
    DistanceWeight,
    DurationTolerance,
    DurationWeight,
    Keys,
)
from reperform.nodes.synthesis.key_frame_targets import asked_targets, moves_between

_WHO = "synthesis.target_grid"
# Beyond the greatest targets, so that the nearest of one that cannot be met is seen.
_FURTHER = 2.0
_LATER = 4.0


@node(over="dataset", memory=2.0)
def target_grid(
    graph: MotionGraph,
    meshes: Dataset[MeshSequence],
    *,
    keys: Keys,
    distances: Annotated[tuple[float, float, float], Param("m", about="targets: first, last, step")] = (
        1.0,
        20.0,
        1.0,
    ),
    durations: Annotated[tuple[float, float, float], Param("s", about="targets: first, last, step")] = (
        1.0,
        40.0,
        1.0,
    ),
    distance_weight: DistanceWeight = 10 / 3,
    duration_weight: DurationWeight = 2.5,
    distance_tolerance: DistanceTolerance = 0.05,
    duration_tolerance: DurationTolerance = 0.08,
    cells: Annotated[
        float, Param("1e6", 1.0, 4000.0, "size of the table; finer distances with more")
    ] = 150.0,
) -> TargetGrid:
    """The cheapest walk for every target of distance and duration, from one table per key-frame sequence.

    Cost, key frames and tolerances are those of `synthesis.key_frames`. The table of what remains to be paid by (place,
    steps, distance) is filled once; each target is then searched for, led by it.
    `status` is 1 where the target is met, 0 where it is proved that no walk meets it, -1 where neither could be
    shown; of the latter two the nearest walk is told.

    Raises ValueError where a key frame does not exist, key frames cannot be joined, or targets do not rise.

    Source: Huang, Tejera, Collomosse and Hilton 2015, ACM TOG (000 section 6.1, table III: 20 x 40 targets).
    Departure: one table serves all targets; 000 solves one integer program for each.
    """
    rate = float(graph.fps)
    far, late = _rising(distances, "distances"), _rising(durations, "durations")
    rows = []
    for sequence in keys:
        moves, _ = moves_between(graph, meshes, [key.strip() for key in sequence.split(">")], _WHO)
        search = PreparedSearch.fill(
            moves,
            int(np.ceil((late[-1] + _LATER) * rate)),
            far[-1] + _FURTHER,
            distance_weight,
            int(cells * 1e6),
        )
        for metres in far:
            for seconds in late:
                targets = asked_targets(
                    metres, seconds, (distance_weight, duration_weight),
                    (distance_tolerance, duration_tolerance), rate, _WHO,
                )  # fmt: skip
                rows.append(_answer(search, targets, len(graph.source), rate))
    shape = (len(keys), len(far), len(late))
    columns = [np.array(column).reshape(*shape, *np.shape(column[0])) for column in zip(*rows, strict=True)]
    return TargetGrid(np.array(keys), far, late, *columns)


def _answer(
    search: PreparedSearch, targets: Targets, transitions: int, rate: float
) -> tuple[float, float, float, float, np.int8, np.ndarray]:
    answer = search.ask(targets)
    walk = answer.walk if answer.walk is not None else search.nearest(targets)
    status = np.int8(1 if answer.walk is not None else 0 if answer.proved else -1)
    if walk is None:
        return np.nan, np.nan, np.nan, np.nan, status, np.zeros(transitions, np.int16)
    taken = np.bincount(np.array(walk.passages, int), minlength=transitions).astype(np.int16)
    return walk.distance, (walk.steps + 1) / rate, walk.cost, walk.bound, status, taken


def _rising(span: tuple[float, float, float], name: str) -> np.ndarray:
    first, last, step = span
    if not (0 <= first <= last and step > 0):
        raise ValueError(
            f"{_WHO}: {name} must be first, last, step with 0 <= first <= last and step > 0, got {span}"
        )
    return first + step * np.arange(int(np.floor((last - first) / step + 1e-9)) + 1)
