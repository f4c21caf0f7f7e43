"""What walks through a motion graph share: transitions as passages, ground tracks, the path made of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reperform.nodes.kernels.ground_plane import Placement
from reperform.nodes.kernels.path_frames import Passage, PathFrames, arc_length, ground_track
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph, MotionPath, Provenance


def passages_of(graph: MotionGraph) -> list[Passage]:
    """The transitions of a graph, in its order."""
    fields = (graph.source, graph.target, graph.source_frame, graph.target_frame, graph.length)
    source, target, m, n, length = (np.asarray(field).astype(int).tolist() for field in fields)
    yaw, offset = np.asarray(graph.yaw), np.asarray(graph.offset)
    return [
        Passage(*row, Placement(float(yaw[k]), offset[k].astype(np.float64)))
        for k, row in enumerate(zip(source, target, m, n, length, strict=True))
    ]


def ground_tracks(graph: MotionGraph, meshes: Dataset[MeshSequence], who: str) -> list[np.ndarray]:
    """The centroid (mean vertex) of each take of the graph on the ground, (frames, 2), m.

    Raises ValueError where the graph was made of other takes.
    """
    tracks = []
    for take, frames in zip(map(str, np.asarray(graph.takes)), np.asarray(graph.frames), strict=True):
        if take not in meshes:
            raise ValueError(f"{who}: the graph has take {take!r}, the meshes have {', '.join(meshes)}")
        vertices = np.asarray(meshes[take].vertices)
        if len(vertices) != frames:
            raise ValueError(
                f"{who}: take {take!r} has {frames} frames in the graph and {len(vertices)} in the meshes"
            )
        tracks.append(vertices[:, :, [0, 2]].mean(axis=1, dtype=np.float64))
    return tracks


def motion_path(
    graph: MotionGraph,
    frames: PathFrames,
    tracks: Sequence[np.ndarray],
    taken: Sequence[int],
    *,
    distance: float = np.nan,
    duration: float = np.nan,
    cost: float,
    bound: float,
) -> MotionPath:
    """The product of a walk: what was asked (nan where free) beside what its frames really cover."""
    track = ground_track(frames, tracks)
    rate = float(graph.fps)
    reached = arc_length(track), len(track) / rate
    return MotionPath(
        provenance=Provenance(np.asarray(graph.takes), *frames),
        transition=np.array(taken, np.int32),
        distance=np.array([reached[0], distance], np.float32),
        displacement=np.asarray(np.linalg.norm(track[-1] - track[0]), np.float32),
        duration=np.array([reached[1], duration], np.float32),
        cost=np.asarray(cost, np.float32),
        bound=np.asarray(bound, np.float32),
        fps=np.asarray(graph.fps, np.float32),
    )
