"""What brings the colours of cameras together."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class ColourMatch(NamedTuple):
    """Factors on red, green and blue of each camera, after which they show a surface point alike."""

    gain: Annotated[np.ndarray, Axes("camera", "3")]
