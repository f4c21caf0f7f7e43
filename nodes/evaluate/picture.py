"""Picture errors as measurements."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.picture_error import PictureError


@node(over="frame")
def picture(error: PictureError) -> Measures:
    """PSNR (dB), SSIM and overlap of rendered views, as entries `psnr`, `ssim` and `overlap`.

    Source: the definitions in `texture.picture_error`.
    """
    return Measures(
        np.array([float(error.psnr), float(error.ssim), float(error.overlap)]),
        np.array(["psnr", "ssim", "overlap"]),
        np.array(["dB", "1", "1"]),
    )
