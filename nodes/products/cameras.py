"""Calibrated cameras."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class Cameras(NamedTuple):
    """A fixed rig. OpenCV's model: x_cam = R x_world + t; x right, y down, z forward; pixel (0, 0) is a centre."""

    matrix: Annotated[np.ndarray, Axes("camera", "3", "3", dtype="float64", unit="px")]
    rotation: Annotated[np.ndarray, Axes("camera", "3", "3", dtype="float64")]
    translation: Annotated[np.ndarray, Axes("camera", "3", dtype="float64", unit="m")]
    # k1 k2 p1 p2 k3, OpenCV's order
    distortion: Annotated[np.ndarray, Axes("camera", "5", dtype="float64")]
    # width, height
    image_size: Annotated[np.ndarray, Axes("camera", "2", dtype="int32", unit="px")]
    name: Annotated[np.ndarray, Axes("camera", dtype="str")]


class CameraPath(NamedTuple):
    """One virtual, undistorted camera that may move: a pose per frame of what it films."""

    matrix: Annotated[np.ndarray, Axes("frame", "3", "3", dtype="float64", unit="px")]
    rotation: Annotated[np.ndarray, Axes("frame", "3", "3", dtype="float64")]
    translation: Annotated[np.ndarray, Axes("frame", "3", dtype="float64", unit="m")]
    # width, height
    image_size: Annotated[np.ndarray, Axes("2", dtype="int32", unit="px")]
