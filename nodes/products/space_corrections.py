"""What linear blending in a parametric space lacks."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class SpaceCorrections(NamedTuple):
    """Sparse corrections of the linear blend in every cell of a parametric space, at bisected weights of its corners.

    Fields of kernels.hybrid_blend.HybridFields, those of all cells one after another; blend.cell_fields takes them
    apart.
    """

    # of which space: its inputs, cells, poses and vertices
    takes: Annotated[np.ndarray, Axes("input", dtype="str")]
    cells: Annotated[np.ndarray, Axes("cell", "corner", dtype="int32")]
    poses: Annotated[np.ndarray, Axes(dtype="int32")]
    vertices: Annotated[np.ndarray, Axes(dtype="int32")]
    # a correction is stored where it is longer than this; how far each pose may be from the non-linear blend
    epsilon: Annotated[np.ndarray, Axes(dtype="float64", unit="m")]
    error: Annotated[np.ndarray, Axes("cell", "pose", dtype="float64", unit="m")]
    # bits per code: 8 or 16
    bits: Annotated[np.ndarray, Axes("cell", dtype="int32")]
    # how many simplices, corrections, runs, bytes of code
    counts: Annotated[np.ndarray, Axes("cell", "4", dtype="int32")]
    split: Annotated[np.ndarray, Axes("simplex", dtype="int32")]
    child: Annotated[np.ndarray, Axes("simplex", dtype="int32")]
    start: Annotated[np.ndarray, Axes("run_of_pose", dtype="int64")]
    first: Annotated[np.ndarray, Axes("run", dtype="int32")]
    begin: Annotated[np.ndarray, Axes("run_end", dtype="int32")]
    code: Annotated[np.ndarray, Axes("byte", dtype="uint8")]
    step: Annotated[np.ndarray, Axes("correction", "pose", unit="m")]
