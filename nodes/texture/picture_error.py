"""A rendered view against the real one."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.picture_error import psnr, ssim
from reperform.nodes.products.footage import Film, Footage, Mattes
from reperform.nodes.products.picture_error import PictureError


@node(over="frame")
def picture_error(
    film: Film,
    footage: Footage,
    mattes: Mattes,
    *,
    camera: Annotated[int, Param("1", 0, 999, "the real camera that the film stands in for")] = 0,
    background: Annotated[float, Param("1/255", 0, 255, "grey behind the performer in the film")] = 128.0,
) -> PictureError:
    """PSNR and SSIM of a film against what a camera saw, over the performer.

    The real picture is laid over the film's grey by its matte: a I + (1 - a) background; the mask is the
    union of the matte (a >= 1/2) and the film's coverage (>= 1/2), so a wrong outline counts as an error.
    PSNR = 10 log10(255^2 / mean squared error); overlap = |both| / |union|.

    Raises ValueError where film and footage differ in size or the camera does not exist.

    Source: Wang, Bovik, Sheikh and Simoncelli 2004, IEEE TIP 13(4) (SSIM); leave-one-out error of rendered
    views as in Waechter et al. 2017, ACM TOG 36(1), "Virtual rephotography".
    """
    if camera >= len(footage.images):
        raise ValueError(f"texture.picture_error: camera must be under {len(footage.images)}, got {camera}")
    alpha = mattes.alpha[camera].astype(np.float32)[..., None] / 255
    truth = alpha * footage.images[camera] + (1 - alpha) * background
    real, rendered = mattes.alpha[camera] >= 128, film.coverage >= 128
    union = real | rendered
    overlap = (real & rendered).sum() / max(union.sum(), 1)
    return PictureError(
        np.asarray(psnr(film.images, truth, union), np.float32),
        np.asarray(ssim(film.images, truth, union), np.float32),
        np.asarray(overlap, np.float32),
        footage.fps,
    )
