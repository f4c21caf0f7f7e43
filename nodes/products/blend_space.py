"""Takes that can be blended at any weights in real time."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class BlendSpace(NamedTuple):
    """N takes of one topology, pose by corresponding pose, and sparse corrections of their linear blend.

    The last eight fields are those of `nodes.kernels.hybrid_blend.HybridFields`.
    """

    takes: Annotated[np.ndarray, Axes("input", dtype="str")]
    vertices: Annotated[np.ndarray, Axes("input", "pose", "vertex", "3", unit="m")]
    faces: Annotated[np.ndarray, Axes("face", "3", dtype="int32")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]
    # weights of every correction, and how far each pose's blend may be from the non-linear one
    weights: Annotated[np.ndarray, Axes("correction", "input", dtype="float64")]
    error: Annotated[np.ndarray, Axes("pose", dtype="float64", unit="m")]
    # a correction is stored where it is longer than this
    epsilon: Annotated[np.ndarray, Axes(dtype="float64", unit="m")]
    # bits per code: 8 or 16
    bits: Annotated[np.ndarray, Axes(dtype="int32")]
    split: Annotated[np.ndarray, Axes("simplex", dtype="int32")]
    child: Annotated[np.ndarray, Axes("simplex", dtype="int32")]
    start: Annotated[np.ndarray, Axes("run_of_pose", dtype="int64")]
    first: Annotated[np.ndarray, Axes("run", dtype="int32")]
    begin: Annotated[np.ndarray, Axes("run_end", dtype="int32")]
    code: Annotated[np.ndarray, Axes("byte", dtype="uint8")]
    step: Annotated[np.ndarray, Axes("correction", "pose", unit="m")]
