"""Motions for a whole grid of targets."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes

_GRID = ("sequence", "target_distance", "target_duration")


class TargetGrid(NamedTuple):
    """The best walk of every key-frame sequence for every pair of a target distance and a target duration.

    Where a target cannot be met, what is reached is the nearest that can, and its bound is nan.
    """

    # key frames of a sequence as TAKE:FRAME > TAKE:FRAME
    keys: Annotated[np.ndarray, Axes("sequence", dtype="str")]
    distance: Annotated[np.ndarray, Axes("target_distance", dtype="float64", unit="m")]
    duration: Annotated[np.ndarray, Axes("target_duration", dtype="float64", unit="s")]
    reached_distance: Annotated[np.ndarray, Axes(*_GRID, dtype="float64", unit="m")]
    reached_duration: Annotated[np.ndarray, Axes(*_GRID, dtype="float64", unit="s")]
    cost: Annotated[np.ndarray, Axes(*_GRID, dtype="float64", unit="1")]
    # lower bound of the cost of any walk that meets the target: cost - bound is the gap
    bound: Annotated[np.ndarray, Axes(*_GRID, dtype="float64", unit="1")]
    # 1 met within the tolerances, 0 proved that no walk meets it, -1 neither met nor disproved
    status: Annotated[np.ndarray, Axes(*_GRID, dtype="int8")]
    # how often each transition of the graph is taken
    taken: Annotated[np.ndarray, Axes(*_GRID, "transition", dtype="int16")]
