"""Several measures of dissimilarity side by side."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class MeasureComparison(NamedTuple):
    """All frames of all takes, take after take, against one another under several measures, and the transitions
    that each measure would choose.
    """

    measures: Annotated[np.ndarray, Axes("measure", dtype="str")]
    takes: Annotated[np.ndarray, Axes("take", dtype="str")]
    # of each take, in the order of the rows
    frames: Annotated[np.ndarray, Axes("take", dtype="int32")]
    # each measure in its own unit; rows are left, columns are entered
    distance: Annotated[np.ndarray, Axes("measure", "row", "column")]
    # chosen transitions: which measure, and the frames in the middle of the window within their takes
    measure: Annotated[np.ndarray, Axes("transition", dtype="int32")]
    source: Annotated[np.ndarray, Axes("transition", dtype="int32")]
    target: Annotated[np.ndarray, Axes("transition", dtype="int32")]
    source_frame: Annotated[np.ndarray, Axes("transition", dtype="int32")]
    target_frame: Annotated[np.ndarray, Axes("transition", dtype="int32")]
    # mean dissimilarity over the window, in the measure's unit
    cost: Annotated[np.ndarray, Axes("transition", dtype="float64")]
    half_length: Annotated[np.ndarray, Axes(dtype="int32", unit="frame")]
