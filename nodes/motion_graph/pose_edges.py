"""What graphs of poses are made of: all transitions of a dataset in one matrix, and chosen ones as a graph."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.shortest_paths import sparse_paths
from reperform.nodes.product import Pairs
from reperform.nodes.products.essential import PoseGraph, PoseTransitions


class Transitions(NamedTuple):
    """The complete digraph: matrices (P, P) over all poses, take after take."""

    takes: list[str]
    frames: list[int]
    # E, with the captured way where it is no dearer
    cost: np.ndarray
    # E of blended transitions alone
    blended: np.ndarray
    deformation: np.ndarray
    duration: np.ndarray
    source_length: np.ndarray
    target_length: np.ndarray
    alpha: float
    fps: np.ndarray


def complete_digraph(transitions: Pairs[PoseTransitions], who: str) -> Transitions:
    """All transitions side by side; within a take, i < j, E = min(alpha (j - i), D + alpha L).

    Raises ValueError where a pair of takes is missing, or alpha or the frame rate differ.
    """
    takes = list(dict.fromkeys(take for pair in transitions for take in pair))
    missing = [f"{a} to {b}" for a in takes for b in takes if (a, b) not in transitions]
    if missing or not takes:
        raise ValueError(
            f"{who}: every ordered pair of takes is needed, itself included; missing: {missing[0] if missing else 'all'}"
        )
    known = [(float(p.alpha), round(float(p.fps), 3)) for p in transitions.values()]
    if len(set(known)) > 1:
        raise ValueError(
            f"{who}: all pairs must share alpha and frame rate, got {known[0]} and "
            f"{next(pair for pair in known if pair != known[0])}"
        )
    deformation, duration, source_length, target_length = (
        np.block([[np.asarray(getattr(transitions[a, b], name)) for b in takes] for a in takes])
        for name in ("deformation", "duration", "source_length", "target_length")
    )
    alpha = known[0][0]
    frames = [int(np.asarray(transitions[take, take].duration).shape[0]) for take in takes]
    blended = deformation.astype(np.float64) + alpha * duration
    cost = np.minimum(blended, alpha * captured_steps(frames))
    fps = np.asarray(next(iter(transitions.values())).fps, np.float32)
    return Transitions(
        takes, frames, cost, blended, deformation, duration, source_length, target_length, alpha, fps
    )


def captured_steps(frames: list[int]) -> np.ndarray:
    """Frames from each pose on to each later one of its take, (P, P); inf where there is no captured way."""
    take = np.repeat(np.arange(len(frames)), frames)
    place = np.arange(len(take))
    ahead = (place[None] - place[:, None]).astype(np.float64)
    return np.where((take[:, None] == take[None]) & (ahead > 0), ahead, np.inf)


def pose_graph(all_of: Transitions, source: np.ndarray, target: np.ndarray) -> PoseGraph:
    """The graph with these edges of the complete digraph, and its shortest paths."""
    steps = captured_steps(all_of.frames)[source, target]
    cost = all_of.cost[source, target]
    played = steps * all_of.alpha <= cost
    distance, predecessor = sparse_paths(len(all_of.cost), source, target, cost)
    deformation = np.where(played, 0.0, all_of.deformation[source, target]).astype(np.float32)
    duration, first, second = (
        np.where(played, captured, field[source, target]).astype(np.int32)
        for captured, field in (
            (np.where(played, steps, 0), all_of.duration),
            (0, all_of.source_length),
            (0, all_of.target_length),
        )
    )
    return PoseGraph(
        np.array(all_of.takes), np.array(all_of.frames, np.int32), source, target, cost, deformation, duration,
        first, second, distance, predecessor, np.array(all_of.alpha), all_of.fps,
    )  # fmt: skip
