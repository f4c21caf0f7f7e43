"""Shape and colour of a surface, as sparse histograms."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class ShapeColourHistograms(NamedTuple):
    """Share of the surface by where it is and what colour it has: the bins that hold something, in order.

    Bin (radius, polar, azimuth, red, green, blue) has the number that C order gives it. `point` and `colour` are
    the means of what the bin holds, so that turning a bin by any angle is turning its point.
    """

    bin: Annotated[np.ndarray, Axes("frame", "entry*", dtype="int32")]
    # sums to 1 over the entries of a frame
    share: Annotated[np.ndarray, Axes("frame", "entry*", dtype="float64")]
    # from the centre of mass
    point: Annotated[np.ndarray, Axes("frame", "entry*", "3", unit="m")]
    # 0 to 1
    colour: Annotated[np.ndarray, Axes("frame", "entry*", "3")]
    centre: Annotated[np.ndarray, Axes("frame", "3", unit="m")]
    # of each dimension
    bins: Annotated[np.ndarray, Axes("6", dtype="int32")]
    reach: Annotated[np.ndarray, Axes(unit="m")]
