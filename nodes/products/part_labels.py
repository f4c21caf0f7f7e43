"""Body parts marked on a mesh."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class PartLabels(NamedTuple):
    """The part each vertex of one topology belongs to; marked once, it holds for every frame of every take."""

    # index into names; -1: no part
    label: Annotated[np.ndarray, Axes("vertex", dtype="int32")]
    names: Annotated[np.ndarray, Axes("part", dtype="str")]
