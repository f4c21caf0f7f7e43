"""A walk through a pose graph, frame by frame."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class PoseWalk(NamedTuple):
    """What a walk plays: up to two captured moments a frame, their weights and placements, and what it promises.

    The ground-plane placement takes captured coordinates to the world:
    x_world = R_y(yaw) x_capture + (offset_x, 0, offset_z).
    """

    takes: Annotated[np.ndarray, Axes("take", dtype="str")]
    take: Annotated[np.ndarray, Axes("frame", "2", dtype="int32")]
    # moments within the takes, between captured frames too
    time: Annotated[np.ndarray, Axes("frame", "2", dtype="float64", unit="frame")]
    # rows sum to 1; an unused second source has weight 0
    weight: Annotated[np.ndarray, Axes("frame", "2", dtype="float64")]
    yaw: Annotated[np.ndarray, Axes("frame", "2", dtype="float64", unit="rad")]
    offset: Annotated[np.ndarray, Axes("frame", "2", "2", dtype="float64", unit="m")]
    # centre of the body (mean vertex), and where it was wanted (nan: nowhere)
    middle: Annotated[np.ndarray, Axes("frame", "3", dtype="float64", unit="m")]
    wanted: Annotated[np.ndarray, Axes("frame", "3", dtype="float64", unit="m")]
    # captured poses that were asked for, as the frames of the walk that show them, and when they were asked for
    shown: Annotated[np.ndarray, Axes("key", dtype="int32", unit="frame")]
    asked: Annotated[np.ndarray, Axes("key", dtype="float64", unit="frame")]
    # the poses at which moves begin and end, counted through all takes
    pose: Annotated[np.ndarray, Axes("stop", dtype="int32")]
    cost: Annotated[np.ndarray, Axes(dtype="float64")]
    # lower bound of the cost of any walk that does what was asked
    bound: Annotated[np.ndarray, Axes(dtype="float64")]
    # moves that the search tried
    expanded: Annotated[np.ndarray, Axes(dtype="int64")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]
