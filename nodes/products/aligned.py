"""Surfaces brought to one topology."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes
from reperform.nodes.products.mesh import MeshSequence


class AlignedSequence(NamedTuple):
    """One take in the topology of the root frame of all takes, and how far each frame can be trusted."""

    mesh: MeshSequence
    # mean distance of the aligned surface from the captured one and back
    residual: Annotated[np.ndarray, Axes("frame", unit="m")]
    # root mean square of log(edge length / edge length at the root)
    stretch: Annotated[np.ndarray, Axes("frame")]
    # residual and stretch are within the gates
    trusted: Annotated[np.ndarray, Axes("frame", dtype="bool")]
    # the frame whose surface gave the topology
    root_take: Annotated[np.ndarray, Axes(dtype="str")]
    root_frame: Annotated[np.ndarray, Axes(dtype="int32")]
