"""The motion graph over the same transitions: local minima between takes."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import minimum_filter

from reperform.nodes.declaration import node
from reperform.nodes.motion_graph.pose_edges import captured_steps, complete_digraph, pose_graph
from reperform.nodes.product import Pairs
from reperform.nodes.products.essential import PoseGraph, PoseTransitions


@node(over="dataset", memory=2.0)
def local_minima(transitions: Pairs[PoseTransitions]) -> PoseGraph:
    """All frames of all takes, each with the next, and the transitions at local minima of their cost.

    An edge from i to j stays where E(i, j) is at most that of its eight neighbours in the matrix of its pair of takes;
    no minimum is left out for being high, so that the graph is as connected as it can be. Poses that it does not
    join have an infinite distance.

    Raises ValueError where a pair of takes is missing, or alpha or the frame rate differ.

    Source: Kovar, Gleicher and Pighin 2002, SIGGRAPH, as 002 section 6 compares with it.
    """
    complete = complete_digraph(transitions, "motion_graph.local_minima")
    chosen = captured_steps(complete.frames) == 1
    ends = np.cumsum(complete.frames)
    for row, rows in zip(ends, complete.frames, strict=True):
        for column, columns in zip(ends, complete.frames, strict=True):
            block = (slice(row - rows, row), slice(column - columns, column))
            cost = complete.blended[block]
            chosen[block] |= cost <= minimum_filter(cost, size=3, mode="nearest")
    np.fill_diagonal(chosen, False)
    source, target = (index.astype(np.int32) for index in np.nonzero(chosen))
    return pose_graph(complete, source, target)
