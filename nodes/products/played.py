"""Motion that a directed character made, and how."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes
from reperform.nodes.products.mesh import MeshSequence


class Played(NamedTuple):
    """What a character did under commands, frame by frame, and where every frame comes from."""

    mesh: MeshSequence
    # x, z (m) and yaw (rad) of the ground point under the character
    root: Annotated[np.ndarray, Axes("frame", "3", dtype="float64")]
    # what the frame is blended of: takes, captured frames (not whole), weights of sum 1 (0 where unused)
    takes: Annotated[np.ndarray, Axes("take", dtype="str")]
    take: Annotated[np.ndarray, Axes("frame", "source", dtype="int32")]
    source_frame: Annotated[np.ndarray, Axes("frame", "source", dtype="float64", unit="frame")]
    weight: Annotated[np.ndarray, Axes("frame", "source", dtype="float64")]
    # the space that plays (during a transition the one it goes to), where in it, and how far the transition is
    spaces: Annotated[np.ndarray, Axes("space", dtype="str")]
    space: Annotated[np.ndarray, Axes("frame", dtype="int32")]
    pose: Annotated[np.ndarray, Axes("frame", dtype="float64")]
    mix: Annotated[np.ndarray, Axes("frame", dtype="float64")]
    # feet that the blended motion rests on, and the middle of every sole
    planted: Annotated[np.ndarray, Axes("frame", "foot", dtype="bool")]
    soles: Annotated[np.ndarray, Axes("frame", "foot", "3", dtype="float64", unit="m")]
    # what was asked, when, of which space, and how long until it began; nan where it never did
    request_time: Annotated[np.ndarray, Axes("request", dtype="float64", unit="s")]
    request_space: Annotated[np.ndarray, Axes("request", dtype="int32")]
    latency: Annotated[np.ndarray, Axes("request", dtype="float64", unit="s")]
    # parameters of all spaces: what the command of the frame asks and what the motion does (by the maps of the spaces,
    # measured on their blends); nan where the space that is asked, or that plays, has no such parameter
    parameters: Annotated[np.ndarray, Axes("parameter", dtype="str")]
    units: Annotated[np.ndarray, Axes("parameter", dtype="str")]
    asked: Annotated[np.ndarray, Axes("frame", "parameter", dtype="float64")]
    done: Annotated[np.ndarray, Axes("frame", "parameter", dtype="float64")]
    # the way that was to be followed, x, z; empty where there was none
    way: Annotated[np.ndarray, Axes("sample", "2", dtype="float64", unit="m")]
