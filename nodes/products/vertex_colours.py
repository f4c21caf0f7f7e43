"""Colours that stay on the vertices of a mesh."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class VertexColours(NamedTuple):
    """One colour per vertex of one topology, for all its frames and takes."""

    colour: Annotated[np.ndarray, Axes("vertex", "3", dtype="uint8", unit="1/255")]
