"""Quantities measured frame by frame."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class Measures(NamedTuple):
    """What was measured of each frame, entry by entry (a camera, an error, a share); nan: not measured."""

    value: Annotated[np.ndarray, Axes("frame", "entry", dtype="float64")]
    name: Annotated[np.ndarray, Axes("entry", dtype="str")]
    # per entry, such as m, s, dB; "1" for a share
    unit: Annotated[np.ndarray, Axes("entry", dtype="str")]
