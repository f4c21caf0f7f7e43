"""The surface motion graph: takes joined by transitions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.ground_plane import align
from reperform.nodes.kernels.strong_part import strong_part
from reperform.nodes.kernels.transition_edits import Edit
from reperform.nodes.kernels.transitions import find_transitions
from reperform.nodes.product import Dataset, Pairs
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity, MotionGraph

# Vertices that tell a placement; more would not move it.
_SAMPLE = 400


class _Candidate(NamedTuple):
    source: int
    target: int
    m: int
    n: int
    length: int
    cost: float


@node(over="dataset", memory=1.0)
def surface(
    similarity: Pairs[Dissimilarity],
    meshes: Dataset[MeshSequence],
    *,
    transitions: Annotated[int, Param("1", 1, 100, "transitions kept per ordered pair of takes (N)")] = 4,
    shortest: Annotated[float, Param("s", 0.02, 2.0, "least half length L of a transition")] = 0.2,
    longest: Annotated[float, Param("s", 0.02, 2.0, "greatest half length L of a transition")] = 0.96,
    threshold: Annotated[
        float, Param("1", 0.0, 1.0, "greatest cost, in units of the largest dissimilarity of the dataset")
    ] = 0.5,
    self_transitions: Annotated[bool, Param(about="whether a take may pass into itself")] = True,
    apart: Annotated[float, Param("s", 0.0, 60.0, "least time between both ends within one take")] = 0.4,
    remove: Annotated[
        tuple[str, ...], Param(about="transitions to leave out, as SOURCE>TARGET or SOURCE:FIRST-LAST>TARGET")
    ] = (),
    only: Annotated[
        tuple[str, ...], Param(about="if any, the only transitions to keep, written as for `remove`")
    ] = (),
    forbid: Annotated[
        tuple[str, ...], Param(about="frames that no transition may blend, as TAKE or TAKE:FIRST-LAST")
    ] = (),
) -> MotionGraph:
    """Takes as nodes, and for every ordered pair of takes its N best transitions (m, n, L) as edges.

    similarity: (frames of a, frames of b) per ordered pair; meshes: takes of one topology, m.

        cost(m, n, L) = sum_k a'(k) c(m + k, n + k) / sum_k a'(k),   a'(k) = min(1 - a, a), a = (k + L) / 2 L

    over |k| <= L, in units of the largest c of the dataset. Each transition carries the ground-plane motion
    that lays its target window on its source window (least squares with the weights a'). `core` marks the
    largest
    strongly connected part: a walk that keeps to it never dies; nothing else is thrown away.

    Raises ValueError where takes differ in topology or frame rate, a matrix does not fit its takes, an edit
    cannot be read, or no transition is left.

    Source: Huang, Tejera, Collomosse and Hilton 2015, ACM TOG (000 eqs 2-5, section 4.3).
    Departure: the cost is normalised by the weights (as printed the shortest window always wins); candidates
    are local minima of the windowed cost and differ from each other by at least the shortest L; Kovar,
    Gleicher and Pighin 2002 for the ground-plane placement and for pruning to the strongly connected part.
    """
    takes = tuple(meshes)
    fps = _common(meshes)
    rate = float(fps)
    bounds = (max(1, round(shortest * rate)), round(longest * rate))
    if bounds[1] < bounds[0]:
        raise ValueError(
            f"motion_graph.surface: longest ({longest} s) must not be below shortest ({shortest} s)"
        )
    largest = _largest(similarity)
    edits = _Edits(takes, remove, only, forbid)
    found: list[_Candidate] = []
    for (a, b), product in similarity.items():
        if a == b and not self_transitions:
            continue
        distance = edits.masked(np.asarray(product.distance, np.float64), a, b)
        expected = (meshes[a].vertices.shape[0], meshes[b].vertices.shape[0])
        if distance.shape != expected:
            raise ValueError(
                f"motion_graph.surface: matrix {a}, {b} must be {expected}, got {distance.shape}"
            )
        best = find_transitions(
            distance,
            transitions,
            *bounds,
            apart=max(1, round(apart * rate)) if a == b else 0,
            spread=bounds[0],
        )
        ends = takes.index(a), takes.index(b)
        for m, n, length, cost in zip(*best, strict=True):
            if cost <= threshold * largest and edits.allow(a, m, b, n):
                found.append(_Candidate(*ends, int(m), int(n), int(length), float(cost) / largest))
    if not found:
        raise ValueError(
            f"motion_graph.surface: no transition within threshold {threshold}, L {shortest} to {longest} s "
            f"and the edits among takes {', '.join(takes)}: raise the threshold, shorten L, use longer takes"
        )
    return _graph(found, takes, meshes, fps)


class _Edits:
    """What the user wants out of the graph."""

    def __init__(
        self, takes: Sequence[str], remove: Sequence[str], only: Sequence[str], forbid: Sequence[str]
    ) -> None:
        who = "motion_graph.surface"
        self.remove = [Edit(text, takes, who) for text in remove]
        self.only = [Edit(text, takes, who) for text in only]
        self.leave = [Edit(f"{text}>*", takes, who) for text in forbid]

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


def _common(meshes: Dataset[MeshSequence]) -> np.ndarray:
    """The frame rate that all takes share, once their topologies are known to agree."""
    first, *others = meshes
    faces, fps = np.asarray(meshes[first].faces), np.asarray(meshes[first].fps)
    for take in others:
        if not np.array_equal(np.asarray(meshes[take].faces), faces):
            raise ValueError(
                f"motion_graph.surface: takes must share one topology; {take} differs from {first}: "
                f"align them first"
            )
        if not np.isclose(np.asarray(meshes[take].fps), fps):
            raise ValueError(
                f"motion_graph.surface: takes must share one frame rate; {first} has {fps} Hz, "
                f"{take} has {np.asarray(meshes[take].fps)} Hz"
            )
    return fps.astype(np.float32)


def _largest(similarity: Pairs[Dissimilarity]) -> float:
    largest = max(float(np.asarray(product.distance).max(initial=0.0)) for product in similarity.values())
    return largest if largest > 0.0 else 1.0


def _graph(
    found: list[_Candidate], takes: Sequence[str], meshes: Dataset[MeshSequence], fps: np.ndarray
) -> MotionGraph:
    samples = [_sample(np.asarray(meshes[take].vertices)) for take in takes]
    placements = [_placement(samples[c.source], samples[c.target], c) for c in found]
    source, target, m, n, length = (np.array([c[k] for c in found], np.int32) for k in range(5))
    return MotionGraph(
        takes=np.array(takes),
        frames=np.array([len(points) for points in samples], np.int32),
        source=source,
        target=target,
        source_frame=m,
        target_frame=n,
        length=length,
        cost=np.array([c.cost for c in found], np.float32),
        yaw=np.array([yaw for yaw, _ in placements]),
        offset=np.array([offset for _, offset in placements]),
        core=strong_part(source, target, m - length, n + length),
        fps=fps,
    )


def _sample(vertices: np.ndarray) -> np.ndarray:
    return vertices[:, :: max(1, vertices.shape[1] // _SAMPLE)]


def _placement(source: np.ndarray, target: np.ndarray, c: _Candidate) -> tuple[float, np.ndarray]:
    window = np.arange(1 - c.length, c.length)
    weights = np.repeat((c.length - np.abs(window)) / c.length, source.shape[1])
    placement, _ = align(source[c.m + window].reshape(-1, 3), target[c.n + window].reshape(-1, 3), weights)
    return placement.yaw, placement.offset
