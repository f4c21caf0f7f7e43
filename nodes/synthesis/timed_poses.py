"""Motion that shows given poses at given times."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.graph_moves import play_moves
from reperform.nodes.kernels.timed_walk import Unreachable, timed_walk
from reperform.nodes.product import Dataset, Pairs
from reperform.nodes.products.essential import PoseGraph
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.products.pose_walk import PoseWalk
from reperform.nodes.synthesis.pose_graph_walk import graph_of, walk_product

_WHO = "synthesis.timed_poses"


@node(over="dataset", memory=1.5)
def timed_poses(
    graph: PoseGraph,
    similarity: Pairs[Dissimilarity],
    meshes: Dataset[MeshSequence],
    *,
    poses: Annotated[
        tuple[str, ...], Param(about="captured poses and when to show them, as TAKE:FRAME@SECONDS, in order")
    ],
    tolerance: Annotated[
        float, Param("s", 0.0, 60.0, "how much earlier or later a pose may be shown")
    ] = 0.08,
    time_weight: Annotated[float, Param("1/s", 0.0, 1e6, "cost of a second too early or too late")] = 2.5,
) -> PoseWalk:
    """The motion of least cost that shows captured poses, unblended, at the times asked for.

        cost = sum over moves of E = D + alpha L + time_weight sum over poses |shown - asked|

    The first pose is shown at the start. The minimum is over all walks through the graph, loops included, by a table
    over frames and time: the bound is the cost itself.

    Raises ValueError where a pose or time cannot be read, times do not increase, or a pose cannot be shown in time;
    it then names the nearest times at which it could be.

    Source: Boukhayma and Boyer 2015, 3DV (002 section 4, pose/time constraints). Departure: dynamic programming over
    all poses together in place of depth-first search pair by pair.
    """
    ready = graph_of(graph, similarity, meshes, _WHO)
    rate = float(ready.fps)
    numbers, seconds = zip(*(_timed(text, ready.pose) for text in poses), strict=True) if poses else ((), ())
    _check(poses, seconds)
    asked = (np.array(seconds) - seconds[0]) * rate
    walk = timed_walk(
        ready.moves,
        np.array(numbers),
        np.rint(asked).astype(np.int64),
        round(tolerance * rate),
        time_weight / rate,
    )
    if isinstance(walk, Unreachable):
        raise ValueError(_too_tight(poses, seconds, walk, rate, tolerance))
    played = play_moves(ready.moves, walk.chain)
    return walk_product(
        ready, played, walk.chain, cost=walk.cost, bound=walk.cost, shown=walk.shown, asked=asked.tolist(),
        expanded=len(ready.moves.source) * int(asked[-1] + 1),
    )  # fmt: skip


def _timed(text: str, pose: Callable[[str, str], int]) -> tuple[int, float]:
    name, _, time = text.rpartition("@")
    try:
        seconds = float(time)
    except ValueError:
        raise ValueError(f"{_WHO}: {text!r} must read TAKE:FRAME@SECONDS") from None
    return pose(name, _WHO), seconds


def _check(poses: Sequence[str], seconds: Sequence[float]) -> None:
    if len(poses) < 2:
        raise ValueError(f"{_WHO}: at least two poses are needed, got {len(poses)}")
    for k in range(1, len(poses)):
        if not seconds[k] > seconds[k - 1]:
            raise ValueError(f"{_WHO}: times must increase, {poses[k]!r} comes after {poses[k - 1]!r}")


def _too_tight(
    poses: Sequence[str], seconds: Sequence[float], walk: Unreachable, rate: float, tolerance: float
) -> str:
    instead = " or ".join(f"{seconds[0] + t / rate:.2f} s" for t in walk.instead)
    return (
        f"{_WHO}: no walk shows {poses[walk.pose]!r} within {tolerance:g} s of its time; "
        f"it could be shown at {instead or 'no time near it'}: ask for that, or widen the tolerance"
    )
