"""What walks through a pose graph share: its moves, poses by name, and the product of a walk."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.graph_moves import Moves, PlayedFrames, graph_moves
from reperform.nodes.kernels.warped_transitions import transition_path
from reperform.nodes.product import Dataset, Pairs
from reperform.nodes.products.essential import PoseGraph
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.products.pose_walk import PoseWalk

# Vertices by which poses are laid on each other and the body's centre is known.
_SAMPLE = 300


class Graph(NamedTuple):
    """A pose graph made ready to be walked."""

    takes: tuple[str, ...]
    frames: np.ndarray
    moves: Moves
    alpha: float
    fps: np.ndarray

    def pose(self, text: str, who: str) -> int:
        """The number of a captured frame TAKE:FRAME among all takes' frames; negative frames count from the end."""
        take, _, frame = text.rpartition(":")
        if take not in self.takes:
            raise ValueError(
                f"{who}: pose {text!r} must read TAKE:FRAME with a take of {', '.join(self.takes)}"
            )
        count = int(self.frames[self.takes.index(take)])
        if not frame.lstrip("-").isdigit() or not -count <= int(frame) < count:
            raise ValueError(f"{who}: pose {text!r}: take {take} has frames 0 .. {count - 1}")
        return int(self.frames[: self.takes.index(take)].sum()) + int(frame) % count


def graph_of(
    graph: PoseGraph, similarity: Pairs[Dissimilarity], meshes: Dataset[MeshSequence], who: str
) -> Graph:
    """The moves of a pose graph between the frames of its takes.

    Raises ValueError where meshes or matrices are not those the graph was made of.
    """
    takes = tuple(str(take) for take in np.asarray(graph.takes))
    frames = np.asarray(graph.frames).astype(int)
    points = []
    for take, count in zip(takes, frames.tolist(), strict=True):
        if take not in meshes:
            raise ValueError(f"{who}: the graph has take {take!r}, the meshes have {', '.join(meshes)}")
        vertices = np.asarray(meshes[take].vertices)
        if len(vertices) != count:
            raise ValueError(
                f"{who}: take {take!r} has {count} frames in the graph and {len(vertices)} in the meshes"
            )
        points.append(vertices[:, :: max(1, vertices.shape[1] // _SAMPLE)].astype(np.float64))
    begin = np.concatenate([[0], np.cumsum(frames)])
    edges = _Edges(graph, similarity, takes, begin, who)
    moves = graph_moves(points, [edges.blend(k) for k in edges.blended], float(graph.alpha))
    return Graph(takes, frames, moves, float(graph.alpha), np.asarray(graph.fps, np.float32))


class _Edges:
    """The blended edges of a graph with their warps."""

    def __init__(
        self,
        graph: PoseGraph,
        similarity: Pairs[Dissimilarity],
        takes: Sequence[str],
        begin: np.ndarray,
        who: str,
    ) -> None:
        self.graph, self.similarity, self.takes, self.begin, self.who = graph, similarity, takes, begin, who
        self.source, self.target = np.asarray(graph.source).astype(int), np.asarray(graph.target).astype(int)
        self.lengths = np.column_stack(
            [np.asarray(graph.source_length), np.asarray(graph.target_length)]
        ).astype(int)
        self.cost, self.alpha = np.asarray(graph.cost, np.float64), float(graph.alpha)
        self.blended = np.flatnonzero(self.lengths.min(axis=1) > 0).tolist()
        self.matrices: dict[tuple[str, str], np.ndarray] = {}

    def blend(self, k: int) -> tuple[int, int, float, np.ndarray]:
        """Edge k as (source, target, cost, path), frames counted through all takes."""
        source, target = int(self.source[k]), int(self.target[k])
        one, other = (int(np.searchsorted(self.begin, pose, "right")) - 1 for pose in (source, target))
        matrix = self._matrix((self.takes[one], self.takes[other]))
        i, j = source - int(self.begin[one]), target - int(self.begin[other])
        path = transition_path(matrix, i, j, int(self.lengths[k, 0]), int(self.lengths[k, 1]), self.alpha)
        return source, target, float(self.cost[k]), path + [self.begin[one], self.begin[other]]

    def _matrix(self, pair: tuple[str, str]) -> np.ndarray:
        if pair not in self.matrices:
            if pair not in self.similarity:
                raise ValueError(
                    f"{self.who}: no matrix of {pair[0]} and {pair[1]}: wire the similarity of the graph"
                )
            self.matrices[pair] = np.asarray(self.similarity[pair].distance, np.float64)
        return self.matrices[pair]


def walk_product(
    graph: Graph,
    played: PlayedFrames,
    chain: Sequence[int],
    *,
    cost: float,
    bound: float,
    expanded: int,
    wanted: np.ndarray | None = None,
    shown: Sequence[int] = (),
    asked: Sequence[float] = (),
) -> PoseWalk:
    """The product of a walk."""
    stops = [int(graph.moves.source[chain[0]]), *(int(graph.moves.target[e]) for e in chain)]
    return PoseWalk(
        takes=np.array(graph.takes),
        take=played.take.astype(np.int32),
        time=played.time,
        weight=played.weight,
        yaw=played.yaw,
        offset=played.offset,
        middle=played.middle,
        wanted=np.full_like(played.middle, np.nan) if wanted is None else wanted,
        shown=np.array(shown, np.int32),
        asked=np.array(asked, np.float64),
        pose=np.array(stops, np.int32),
        cost=np.asarray(cost),
        bound=np.asarray(min(bound, cost)),
        expanded=np.asarray(expanded, np.int64),
        fps=graph.fps,
    )
