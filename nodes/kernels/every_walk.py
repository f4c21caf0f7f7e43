"""All walks of a small graph, tried one by one: what a search must find."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.ground_plane import Placement
from reperform.nodes.kernels.path_frames import Passage, PathFrames, arc_length, ground_track, path_frames
from reperform.nodes.kernels.walk_moves import Spot, Targets


class SmallGraph(NamedTuple):
    """Transitions, their costs (float32), and the centroid of each take on the ground (frames, 2), m."""

    passages: list[Passage]
    costs: np.ndarray
    tracks: list[np.ndarray]


class EveryWalk(NamedTuple):
    """Steps, length (m) and transition cost of every walk, measured on the frames that it plays."""

    steps: np.ndarray
    length: np.ndarray
    cost: np.ndarray

    def least(self, targets: Targets) -> float:
        """The least cost of a walk within the tolerances; inf where there is none."""
        far, late = abs(self.length - targets.distance), abs(self.steps - targets.steps)
        within = (far <= targets.distance_tolerance) & (late <= targets.steps_tolerance)
        return float((self.cost + targets.miss(self.length, self.steps))[within].min(initial=np.inf))


def random_graph(seed: int, frames: Sequence[int] = (16, 12, 20), transitions: int = 12) -> SmallGraph:
    """Takes of these lengths that wander at random, joined by transitions at random."""
    random = np.random.default_rng(seed)
    tracks = [np.cumsum(random.uniform(-0.01, 0.08, size=(n, 2)), axis=0) for n in frames]
    passages: list[Passage] = []
    while len(passages) < transitions:
        source, target = random.integers(len(frames), size=2)
        length = int(random.integers(1, 4))
        m = int(random.integers(length, frames[source] - length))
        n = int(random.integers(length, frames[target] - length))
        placement = Placement(random.uniform(-2, 2), random.normal(size=2) * 0.02)
        passages.append(Passage(int(source), int(target), m, n, length, placement))
    return SmallGraph(passages, random.uniform(0.01, 0.3, size=transitions).astype(np.float32), tracks)


def every_walk(graph: SmallGraph, keys: Sequence[Spot], horizon: int) -> EveryWalk:
    """Every walk of at most `horizon` steps that shows all key frames unblended and in order."""
    rows = []
    for taken, steps in walks(graph.passages, keys[0], keys[-1], horizon):
        frames = path_frames(keys[0].take, keys[0].frame, [graph.passages[k] for k in taken], keys[-1].frame)
        if _shows(frames, keys):
            length = arc_length(ground_track(frames, graph.tracks))
            rows.append((steps, length, float(graph.costs[list(taken)].astype(np.float64).sum())))
    return EveryWalk(*np.array(rows, np.float64).reshape(-1, 3).T)


def walks(
    passages: Sequence[Passage], start: Spot, end: Spot, horizon: int
) -> Iterator[tuple[tuple[int, ...], int]]:
    """Transitions and steps of every walk from start to end of at most `horizon` steps."""
    pending: list[tuple[tuple[int, ...], int, int, int]] = [((), start.take, start.frame, 0)]
    while pending:
        taken, take, frame, steps = pending.pop()
        if take == end.take and frame <= end.frame and steps + end.frame - frame <= horizon:
            yield taken, steps + end.frame - frame
        for k, passage in enumerate(passages):
            more = steps + passage.departure - frame + 2 * passage.length
            if passage.source == take and passage.departure >= frame and more <= horizon:
                pending.append(((*taken, k), passage.target, passage.arrival, more))


def _shows(frames: PathFrames, keys: Sequence[Spot]) -> bool:
    shown = np.stack([frames.take[:, 0], frames.frame[:, 0]], axis=1)
    shown[frames.weight[:, 0] < 1.0] = -1
    place = 0
    for key in keys:
        hits = np.flatnonzero((shown[place:] == key).all(axis=1))
        if len(hits) == 0:
            return False
        place += int(hits[0])
    return True
