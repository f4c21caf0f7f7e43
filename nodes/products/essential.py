"""Transitions between all pairs of poses, and graphs whose nodes are poses."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class PoseTransitions(NamedTuple):
    """The best time-warped transition from every frame of one take to every frame of another.

    A transition from i to j blends source frames i .. i + source_length - 1 with target frames
    j - target_length + 1 .. j; frames beyond the end of the source or the start of the target are held.
    """

    # sum over the cells of the path of the dissimilarity of their two frames
    deformation: Annotated[np.ndarray, Axes("frame_a", "frame_b")]
    # steps from i to j: cells of the path less one
    duration: Annotated[np.ndarray, Axes("frame_a", "frame_b", dtype="int32", unit="frame")]
    source_length: Annotated[np.ndarray, Axes("frame_a", "frame_b", dtype="int32", unit="frame")]
    target_length: Annotated[np.ndarray, Axes("frame_a", "frame_b", dtype="int32", unit="frame")]
    # what a frame of duration costs: E = deformation + alpha duration
    alpha: Annotated[np.ndarray, Axes(dtype="float64", unit="1/frame")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]


class PoseGraph(NamedTuple):
    """A directed graph of all frames of all takes.

    Pose p is frame p - f of take t, f the sum of the frames of the takes before t.
    """

    takes: Annotated[np.ndarray, Axes("take", dtype="str")]
    frames: Annotated[np.ndarray, Axes("take", dtype="int32")]
    # poses that each edge joins
    source: Annotated[np.ndarray, Axes("edge", dtype="int32")]
    target: Annotated[np.ndarray, Axes("edge", dtype="int32")]
    # E = deformation + alpha duration
    cost: Annotated[np.ndarray, Axes("edge", dtype="float64")]
    deformation: Annotated[np.ndarray, Axes("edge")]
    duration: Annotated[np.ndarray, Axes("edge", dtype="int32", unit="frame")]
    # windows of the transition as in PoseTransitions; 0, 0: captured frames are played on
    source_length: Annotated[np.ndarray, Axes("edge", dtype="int32", unit="frame")]
    target_length: Annotated[np.ndarray, Axes("edge", dtype="int32", unit="frame")]
    # cost of the best path between any two poses (inf: none), and the pose before its end (-1: none)
    distance: Annotated[np.ndarray, Axes("pose", "pose", dtype="float64")]
    predecessor: Annotated[np.ndarray, Axes("pose", "pose", dtype="int32")]
    alpha: Annotated[np.ndarray, Axes(dtype="float64", unit="1/frame")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]


class PathCosts(NamedTuple):
    """Costs of best paths between pairs of poses in two graphs, one panel per database."""

    panel: Annotated[np.ndarray, Axes("panel", dtype="str")]
    alpha: Annotated[np.ndarray, Axes("panel", dtype="float64", unit="1/frame")]
    # pairs of poses that the curves stand for
    pairs: Annotated[np.ndarray, Axes("panel", dtype="int32")]
    # columns: the baseline's costs in order, the essential graph's of the same pairs, and those in order
    cost: Annotated[np.ndarray, Axes("panel", "sample", "3")]
