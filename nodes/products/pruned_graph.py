"""A motion graph without dead ends, and what went."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes
from reperform.nodes.products.motion import MotionGraph


class PruningReport(NamedTuple):
    """What was taken out of a motion graph: transitions in the order of the graph, then takes."""

    # a transition as TAKE:FRAME > TAKE:FRAME, or a take
    what: Annotated[np.ndarray, Axes("row", dtype="str")]
    cost: Annotated[np.ndarray, Axes("row", dtype="float64", unit="1")]
    why: Annotated[np.ndarray, Axes("row", dtype="str")]


class PrunedGraph(NamedTuple):
    """The strongly connected part of a motion graph, in which play never ends, and the report of the rest."""

    graph: MotionGraph
    report: PruningReport
