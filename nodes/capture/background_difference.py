"""Mattes against the empty set."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.matte_edge import soft_edge
from reperform.nodes.kernels.performer_component import performer_component
from reperform.nodes.kernels.plate_difference import plate_difference
from reperform.nodes.products.footage import CleanPlate, Footage, Mattes

# Lengths below are meant at this picture width (px) and scale with it.
_WIDTH = 960.0


@node(over="view")
def background_difference(
    footage: Footage,
    plate: CleanPlate,
    *,
    threshold: Annotated[float, Param("deviation", 1, 100, "difference that is half certain")] = 6.0,
    softness: Annotated[float, Param("deviation", 0.1, 50, "half width of the uncertain range")] = 3.0,
    noise: Annotated[float, Param("1/255", 0.5, 50, "deviation assumed at least")] = 3.0,
    shadow: Annotated[float, Param("1", 0, 1, "darkest shadow, as a share of the light; 1: none")] = 0.45,
    hole: Annotated[float, Param("1", 0, 0.1, "share of the picture up to which a hole is filled")] = 5e-4,
    band: Annotated[float, Param("px", 0.5, 10, "half width of the soft edge, at width 960")] = 1.0,
    smallest: Annotated[float, Param("1", 0, 0.5, "least share of the picture a performer covers")] = 2e-4,
) -> Mattes:
    """Soft matte of what is not on the clean plate; shadows count as the set; all 0 where nothing new is.

    images and plate (y, x, 3) -> alpha (y, x). The difference is split into a part along the plate's colour
    (brightness) and a part across it (colour), each in deviations of the plate; a darkening of less than
    1 - `shadow` without change of colour is a shadow. The performer is the largest region that does not hang on
    the picture's edge; small holes are filled; at its edge I = a F + (1 - a) B is solved for a with B the plate.

    Raises ValueError where plate and picture differ in size.
    Source: 004 section 2.2; Horprasert, Harwood and Davis 1999, ICCV (brightness and colour distortion);
    Mishima 1992. Departure: soft edge by the matting equation, since the plate's colour is known there.
    """
    image = np.asarray(footage.images)
    if image.shape != plate.mean.shape:
        raise ValueError(
            f"background_difference: picture and clean plate must have one size, got {image.shape[1]}x{image.shape[0]} "
            f"and {plate.mean.shape[1]}x{plate.mean.shape[0]} px: record the plate with the same camera mode"
        )
    scale = max(image.shape[1] / _WIDTH, 0.25)
    deviation = np.maximum(plate.deviation, np.float32(noise))
    difference = plate_difference(image, plate.mean, deviation, shadow, 0.7 * scale)
    rough = np.clip((difference - threshold) / (2 * softness) + 0.5, 0, 1)
    performer = performer_component(rough > 0.5, round(3 * scale), int(smallest * rough.size))
    alpha = soft_edge(image, rough, performer, plate.mean, int(hole * rough.size), band * scale, scale)
    return Mattes(alpha, footage.fps)
