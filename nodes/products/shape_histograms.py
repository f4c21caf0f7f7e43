"""Shape of a solid, as histograms."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class ShapeHistograms(NamedTuple):
    """Share of the solid's volume by distance from its centre, angle from the vertical and azimuth.

    Azimuth runs from z towards x (the angle of a positive turn about y); every frame sums to 1.
    """

    share: Annotated[np.ndarray, Axes("frame", "radial", "polar", "azimuth")]
    centre: Annotated[np.ndarray, Axes("frame", "3", unit="m")]
    reach: Annotated[np.ndarray, Axes(unit="m")]
