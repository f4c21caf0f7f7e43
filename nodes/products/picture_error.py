"""How far rendered pictures are from real ones."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class PictureError(NamedTuple):
    """Per frame, over the performer: the union of what was rendered and what the matte shows."""

    psnr: Annotated[np.ndarray, Axes("frame", unit="dB")]
    ssim: Annotated[np.ndarray, Axes("frame")]
    # share of the union that both cover
    overlap: Annotated[np.ndarray, Axes("frame")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]
