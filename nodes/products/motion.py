"""Similarity, motion graphs and synthesised motion."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes
from reperform.nodes.products.mesh import MeshSequence


class Dissimilarity(NamedTuple):
    """How far every frame of one take is from every frame of another; 0 for the same."""

    distance: Annotated[np.ndarray, Axes("frame_a", "frame_b", unit="1")]


class ShapeTree(NamedTuple):
    """A spanning tree over all frames of all takes; row k is one frame, the root is its own parent."""

    takes: Annotated[np.ndarray, Axes("take", dtype="str")]
    take: Annotated[np.ndarray, Axes("node", dtype="int32")]
    frame_index: Annotated[np.ndarray, Axes("node", dtype="int32")]
    parent: Annotated[np.ndarray, Axes("node", dtype="int32")]
    distance: Annotated[np.ndarray, Axes("node")]
    # rows in the order in which they can be visited: parents before children
    order: Annotated[np.ndarray, Axes("node", dtype="int32")]


class MotionGraph(NamedTuple):
    """Takes as nodes; transition k leaves take `source[k]` at frame m and enters take `target[k]` at frame n.

    During a transition of length L (frames) source frames m - L .. m + L are blended with target frames
    n - L .. n + L, after the target was placed on the ground plane by (yaw, offset) relative to the source:
    x_source = R_y(yaw) x_target + (offset_x, 0, offset_z).
    """

    takes: Annotated[np.ndarray, Axes("take", dtype="str")]
    frames: Annotated[np.ndarray, Axes("take", dtype="int32")]
    source: Annotated[np.ndarray, Axes("transition", dtype="int32")]
    target: Annotated[np.ndarray, Axes("transition", dtype="int32")]
    source_frame: Annotated[np.ndarray, Axes("transition", dtype="int32")]
    target_frame: Annotated[np.ndarray, Axes("transition", dtype="int32")]
    length: Annotated[np.ndarray, Axes("transition", dtype="int32", unit="frame")]
    # weighted mean dissimilarity over the window, in units of the largest dissimilarity of the dataset
    cost: Annotated[np.ndarray, Axes("transition")]
    yaw: Annotated[np.ndarray, Axes("transition", dtype="float64", unit="rad")]
    offset: Annotated[np.ndarray, Axes("transition", "2", dtype="float64", unit="m")]
    # within the largest strongly connected part, where play never ends
    core: Annotated[np.ndarray, Axes("transition", dtype="bool")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]


class Provenance(NamedTuple):
    """Where each synthesised frame comes from: up to two captured frames, their weights and placements.

    The ground-plane placement takes captured coordinates to the world:
    x_world = R_y(yaw) x_capture + (offset_x, 0, offset_z).
    """

    takes: Annotated[np.ndarray, Axes("take", dtype="str")]
    take: Annotated[np.ndarray, Axes("frame", "2", dtype="int32")]
    source_frame: Annotated[np.ndarray, Axes("frame", "2", dtype="int32")]
    # rows sum to 1; an unused second source has weight 0
    weight: Annotated[np.ndarray, Axes("frame", "2")]
    yaw: Annotated[np.ndarray, Axes("frame", "2", dtype="float64", unit="rad")]
    offset: Annotated[np.ndarray, Axes("frame", "2", "2", dtype="float64", unit="m")]


class MotionPath(NamedTuple):
    """A chosen way through a motion graph, with what it promises: where it goes and how long it takes."""

    provenance: Provenance
    # the transitions taken, in order
    transition: Annotated[np.ndarray, Axes("step", dtype="int32")]
    # what was reached and what was asked (asked is nan where nothing was); distance is the arc length of the
    # centroid's ground track, displacement the straight line between its ends
    distance: Annotated[np.ndarray, Axes("2", unit="m")]
    displacement: Annotated[np.ndarray, Axes(unit="m")]
    duration: Annotated[np.ndarray, Axes("2", unit="s")]
    cost: Annotated[np.ndarray, Axes(unit="1")]
    # lower bound of the cost of any path: cost - bound is the gap
    bound: Annotated[np.ndarray, Axes(unit="1")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]


class Animation(NamedTuple):
    """Synthesised motion and where every frame comes from."""

    mesh: MeshSequence
    provenance: Provenance
