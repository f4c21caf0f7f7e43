"""What key-framed synthesis is asked, read: key frames by name, targets in steps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reperform.nodes.kernels.path_frames import path_frames
from reperform.nodes.kernels.prepared_search import PreparedSearch
from reperform.nodes.kernels.walk_moves import Moves, Spot, Targets, Walk, lay_out, least_steps
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph, MotionPath
from reperform.nodes.synthesis.graph_walk import ground_tracks, motion_path, passages_of


def moves_between(
    graph: MotionGraph, meshes: Dataset[MeshSequence], keys: Sequence[str], who: str
) -> tuple[Moves, list[Spot]]:
    """The moves of a graph between key frames, given as TAKE:FRAME in order.

    Raises ValueError where a key frame does not exist or no walk joins them.
    """
    spots = [key_spot(text, graph, who) for text in keys]
    passages, costs, tracks = passages_of(graph), np.asarray(graph.cost), ground_tracks(graph, meshes, who)
    moves = lay_out(passages, costs, tracks, spots)
    if not moves.reachable:
        shown = next(
            n
            for n in range(len(spots) - 1, 0, -1)
            if n == 1 or lay_out(passages, costs, tracks, spots[:n]).reachable
        )
        raise ValueError(
            f"{who}: no walk through the graph shows {', '.join(keys)} in this order: no way leads from "
            f"{' over '.join(keys[:shown])} to {keys[shown]}: allow more transitions, a higher threshold, or other key frames"
        )
    return moves, spots


def nearest_walk(moves: Moves, targets: Targets, rate: float) -> Walk:
    """The walk nearest to targets that cannot be met, looked for ever wider until nothing beyond can be nearer."""
    steps = int(np.nanmax([targets.steps, 0.0]) + targets.steps_tolerance + least_steps(moves)[0] + 2 * rate)
    reach = np.inf if np.isnan(targets.distance) else targets.distance + targets.distance_tolerance + 2.0
    while True:
        walk = PreparedSearch.fill(moves, steps, reach, targets.distance_weight).nearest(targets)
        if walk is not None:
            beyond = (reach - targets.distance) / targets.distance_tolerance
            after = (steps - targets.steps) / targets.steps_tolerance
            if sum(targets.off(walk.distance, walk.steps)) <= np.nanmin([beyond, after, np.inf]):
                return walk
        steps, reach = 2 * steps, 2.0 * reach


def key_spot(text: str, graph: MotionGraph, who: str) -> Spot:
    """A captured frame from TAKE:FRAME; frames count from 0, negative ones from the end."""
    takes = [str(take) for take in np.asarray(graph.takes)]
    take, _, frame = text.rpartition(":")
    if take not in takes:
        raise ValueError(f"{who}: key frame {text!r} must read TAKE:FRAME with a take of {', '.join(takes)}")
    count = int(np.asarray(graph.frames)[takes.index(take)])
    try:
        number = int(frame)
    except ValueError:
        raise ValueError(
            f"{who}: key frame {text!r} must read TAKE:FRAME with a whole frame number"
        ) from None
    if not -count <= number < count:
        raise ValueError(f"{who}: key frame {text!r}: take {take} has frames 0 .. {count - 1}")
    return Spot(takes.index(take), number % count)


def asked_targets(
    distance: float | None,
    duration: float | None,
    weights: tuple[float, float],
    tolerances: tuple[float, float],
    rate: float,
    who: str,
) -> Targets:
    """Targets in metres and steps (frames - 1), from metres and seconds; weights and tolerances per both.

    Raises ValueError where a tolerance is not positive.
    """
    if min(tolerances) <= 0:
        raise ValueError(f"{who}: tolerances must be above 0, got {tolerances[0]} m, {tolerances[1]} s")
    return Targets(
        np.nan if distance is None else distance,
        np.nan if duration is None else duration * rate - 1.0,
        weights[0],
        weights[1] / rate,
        tolerances[0],
        tolerances[1] * rate,
    )


def path_of(
    graph: MotionGraph,
    meshes: Dataset[MeshSequence],
    spots: Sequence[Spot],
    walk: Walk,
    targets: Targets,
    who: str,
) -> MotionPath:
    """The product of a walk between key frames, beside what was asked."""
    passages, tracks = passages_of(graph), ground_tracks(graph, meshes, who)
    frames = path_frames(spots[0].take, spots[0].frame, [passages[k] for k in walk.passages], spots[-1].frame)
    return motion_path(
        graph, frames, tracks, walk.passages,
        distance=targets.distance, duration=(targets.steps + 1.0) / float(graph.fps),
        cost=walk.cost, bound=walk.bound,
    )  # fmt: skip


def infeasible(keys: Sequence[str], targets: Targets, walk: Walk, rate: float, proved: bool, who: str) -> str:
    """What cannot be met, and the nearest that can."""
    wanted = ((targets.distance, "m"), ((targets.steps + 1.0) / rate, "s"))
    asked = " in ".join(f"{value:g} {unit}" for value, unit in wanted if not np.isnan(value))
    none = "no walk" if proved else "no walk was found that"
    return (
        f"{who}: {none} through {', '.join(keys)} covers {asked or 'anything'} within the tolerances; the nearest that "
        f"can be met is {walk.distance:.3f} m in {(walk.steps + 1) / rate:.2f} s: ask for that, widen the tolerances"
    )
