"""The surface motion graph: takes joined by transitions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.join_preview import captured_acceleration, preview_join
from reperform.nodes.kernels.strong_part import strong_part
from reperform.nodes.kernels.transition_edits import Edit
from reperform.nodes.kernels.transitions import find_transitions, window_cost
from reperform.nodes.motion_graph.transition_parameters import (
    Apart,
    Forbid,
    Jerk,
    Length,
    Longest,
    Only,
    Remove,
    SelfTransitions,
    Shortest,
    Threshold,
    Transitions,
)
from reperform.nodes.product import Dataset, Pairs
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity, MotionGraph

_WHO = "motion_graph.surface"
# Vertices on which joins are foreseen.
_SAMPLE = 200
# Lengths tried between the shortest and the longest.
_LENGTHS = 7
# A join that jerks no more than this, against the capture, need not be longer.
_EASY = 1.0


class _Candidate(NamedTuple):
    source: int
    target: int
    m: int
    n: int
    length: int
    cost: float
    yaw: float
    offset: tuple[float, float]


@node(over="dataset", memory=1.0)
def surface(
    similarity: Pairs[Dissimilarity],
    meshes: Dataset[MeshSequence],
    *,
    transitions: Transitions = 4,
    shortest: Shortest = 0.2,
    longest: Longest = 0.96,
    length: Length = "smooth",
    jerk: Jerk = 1.5,
    threshold: Threshold = 0.5,
    self_transitions: SelfTransitions = True,
    apart: Apart = 0.4,
    remove: Remove = (),
    only: Only = (),
    forbid: Forbid = (),
) -> MotionGraph:
    """Takes as nodes, and for every ordered pair of takes its N best transitions (m, n, L) as edges.

    similarity: (frames of a, frames of b) per ordered pair; meshes: takes of one topology, m.

        cost(m, n, L) = sum_k a'(k) c(m + k, n + k) / sum_k a'(k),   a'(k) = min(1 - a, a), a = (k + L) / 2 L

    over |k| <= L, in units of the largest c of the dataset. Each transition carries the ground-plane motion
    that lays its target window on its source window (least squares with the weights a'). The blend is
    foreseen
    on a few hundred vertices: where no L keeps its peak acceleration (median and 99th percentile of vertices)
    under `jerk` times the 99th percentile of the captured frames', the transition is not made. `core` marks
    the largest strongly connected part: a walk that keeps to it never dies; nothing else is thrown away.

    Raises ValueError where takes differ in topology or frame rate, a matrix does not fit its takes, an edit
    cannot be read, or no transition is left.

    Source: Huang, Tejera, Collomosse and Hilton 2015, ACM TOG (000 eqs 2-5, section 4.3); Kovar, Gleicher and
    Pighin 2002, SIGGRAPH, for the ground-plane motion and the strongly connected part.
    Departure: the cost is divided by its weights (as printed the shortest window always wins); candidates are
    local minima of the windowed cost that differ by at least the shortest L; L is by default chosen by the
    smoothness of the blend, since the cost of a local minimum only grows with L.
    """
    takes = tuple(meshes)
    fps = _frame_rate(meshes)
    bounds = (max(1, round(shortest * float(fps))), round(longest * float(fps)))
    if bounds[1] < bounds[0]:
        raise ValueError(f"{_WHO}: longest ({longest} s) must not be below shortest ({shortest} s)")
    largest = _largest(similarity)
    edits = _Edits(takes, remove, only, forbid)
    joins = _Joins([np.asarray(meshes[take].vertices) for take in takes], bounds, length, jerk)
    found: list[_Candidate] = []
    for (a, b), product in similarity.items():
        if a == b and not self_transitions:
            continue
        source, target = takes.index(a), takes.index(b)
        distance = joins.fitting(np.asarray(product.distance, np.float64), source, target, takes)
        distance = edits.masked(distance, a, b)
        gap = max(1, round(apart * float(fps))) if a == b else 0
        best = find_transitions(distance, 4 * transitions, *bounds, apart=gap, spread=bounds[0])
        kept = 0
        for m, n, half in zip(best.m.tolist(), best.n.tolist(), best.length.tolist(), strict=True):
            if kept == transitions:
                break
            made = joins.make(distance, source, target, m, n, half) if edits.allow(a, m, b, n) else None
            if made and made.cost <= threshold * largest:
                found.append(made._replace(cost=made.cost / largest))
                kept += 1
    if not found:
        raise ValueError(
            f"{_WHO}: no transition among takes {', '.join(takes)} within threshold {threshold}, "
            f"jerk {jerk}, L {shortest} to {longest} s and the edits: raise threshold or jerk, shorten L, use longer takes"
        )
    return _graph(found, takes, [len(points) for points in joins.takes], fps)


class _Joins:
    """Foresees transitions on a few points of each take."""

    def __init__(
        self, vertices: Sequence[np.ndarray], bounds: tuple[int, int], choice: str, jerk: float
    ) -> None:
        step = max(1, vertices[0].shape[1] // _SAMPLE)
        self.takes = [np.ascontiguousarray(points[:, ::step], np.float64) for points in vertices]
        self.weight = np.ones(self.takes[0].shape[1])
        self.bounds, self.choice = bounds, choice
        self.captured = captured_acceleration(self.takes)
        self.limit = jerk if jerk > 0 else np.inf

    def fitting(self, distance: np.ndarray, source: int, target: int, takes: Sequence[str]) -> np.ndarray:
        """The matrix, once it is known to belong to its takes."""
        expected = (len(self.takes[source]), len(self.takes[target]))
        if distance.shape != expected:
            names = f"{takes[source]}, {takes[target]}"
            raise ValueError(f"{_WHO}: matrix {names} must be {expected}, got {distance.shape}")
        return distance

    def make(
        self, distance: np.ndarray, source: int, target: int, m: int, n: int, similar: int
    ) -> _Candidate | None:
        """The transition at (m, n) with its length and placement; None where it would jerk."""
        a, b = self.takes[source], self.takes[target]
        lengths = np.array([similar])
        if self.choice == "smooth":
            room = min(m, n, len(a) - 1 - m, len(b) - 1 - n, self.bounds[1])
            lengths = np.unique(np.linspace(self.bounds[0], room, _LENGTHS).round().astype(int))
        best, least = None, np.inf
        for half in lengths.tolist():
            cost = window_cost(distance, m, n, half)
            if not np.isfinite(cost):
                break
            yaw, x, z, peak = preview_join(
                a, b, m, n, half, self.weight, self.captured, min(least, self.limit)
            )
            if peak < least:
                best, least = _Candidate(source, target, m, n, half, cost, yaw, (x, z)), peak
            if least <= _EASY:
                break
        return best


class _Edits:
    """What the user wants out of the graph."""

    def __init__(
        self, takes: Sequence[str], remove: Sequence[str], only: Sequence[str], forbid: Sequence[str]
    ) -> None:
        self.remove = [Edit(text, takes, _WHO) for text in remove]
        self.only = [Edit(text, takes, _WHO) for text in only]
        self.leave = [Edit(f"{text}>*", takes, _WHO) for text in forbid]

    def masked(self, distance: np.ndarray, a: str, b: str) -> np.ndarray:
        """The matrix with what no window may touch set to infinity."""
        rows = [any(edit.covers(a, m, b, 0) for edit in self.leave) for m in range(distance.shape[0])]
        columns = [any(edit.covers(b, n, a, 0) for edit in self.leave) for n in range(distance.shape[1])]
        if any(rows) or any(columns):
            distance = distance.copy()
            distance[np.array(rows)] = np.inf
            distance[:, np.array(columns)] = np.inf
        return distance

    def allow(self, a: str, m: int, b: str, n: int) -> bool:
        """Whether the transition stays."""
        return not any(edit.covers(a, m, b, n) for edit in self.remove) and (
            not self.only or any(edit.covers(a, m, b, n) for edit in self.only)
        )


def _frame_rate(meshes: Dataset[MeshSequence]) -> np.ndarray:
    """The frame rate that all takes share, once their topologies are known to agree."""
    first, *others = meshes
    faces, fps = np.asarray(meshes[first].faces), np.asarray(meshes[first].fps)
    for take in others:
        if not np.array_equal(np.asarray(meshes[take].faces), faces):
            raise ValueError(
                f"{_WHO}: takes must share one topology; {take} differs from {first}: align them first"
            )
        if not np.isclose(np.asarray(meshes[take].fps), fps):
            other = np.asarray(meshes[take].fps)
            raise ValueError(
                f"{_WHO}: takes must share one frame rate; {first} has {fps} Hz, {take} has {other} Hz"
            )
    return fps.astype(np.float32)


def _largest(similarity: Pairs[Dissimilarity]) -> float:
    largest = max(float(np.asarray(product.distance).max(initial=0.0)) for product in similarity.values())
    return largest if largest > 0.0 else 1.0


def _graph(
    found: list[_Candidate], takes: Sequence[str], frames: Sequence[int], fps: np.ndarray
) -> MotionGraph:
    source, target, m, n, length = (np.array([c[k] for c in found], np.int32) for k in range(5))
    return MotionGraph(
        takes=np.array(takes),
        frames=np.array(frames, np.int32),
        source=source,
        target=target,
        source_frame=m,
        target_frame=n,
        length=length,
        cost=np.array([c.cost for c in found], np.float32),
        yaw=np.array([c.yaw for c in found]),
        offset=np.array([c.offset for c in found]),
        core=strong_part(source, target, m - length, n + length),
        fps=fps,
    )
