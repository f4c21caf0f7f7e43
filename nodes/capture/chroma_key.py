"""Mattes from a blue or green screen."""

from __future__ import annotations

from typing import Annotated, Literal

import cv2
import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.backing_model import backing_distance, backing_field, backing_mode, chromaticity
from reperform.nodes.kernels.matte_edge import soft_edge
from reperform.nodes.kernels.performer_component import performer_component
from reperform.nodes.products.footage import Footage, Mattes

# Lengths below are meant at this picture width (px) and scale with it.
_WIDTH = 960.0


@node(over="view")
def chroma_key(
    footage: Footage,
    *,
    method: Annotated[
        Literal["backing_model", "blue_dominance"], Param(about="learnt backing, or the seed's blue share")
    ] = "backing_model",
    colour: Annotated[Literal["auto", "blue", "green"], Param(about="of the backing")] = "auto",
    threshold: Annotated[float, Param("1", 0.05, 1.5, "distance from the backing; grey is 1 away")] = 0.45,
    softness: Annotated[float, Param("1", 0.01, 0.5, "half width of the uncertain range of distance")] = 0.15,
    reach: Annotated[
        float, Param("px", 10, 1000, "over which the backing's colour may vary, at width 960")
    ] = 40.0,
    band: Annotated[float, Param("px", 0.5, 10, "half width of the soft edge, at width 960")] = 1.0,
    smallest: Annotated[float, Param("1", 0, 0.5, "least share of the picture a performer covers")] = 2e-4,
) -> Mattes:
    """Soft matte of the performer before a blue or green screen; all 0 where no performer stands.

    images (y, x, 3) -> alpha (y, x). The backing's chromaticity is the picture's commonest saturated one, followed
    from place to place. A pixel's distance from it (0 = backing whatever its brightness, 1 = grey) parts the
    picture into certain foreground, certain background and a band; the performer is the largest region that does
    not hang on the picture's edge; in the band I = a F + (1 - a) B is solved for a with the colours F and B of the
    certain pixels near by.
    method="blue_dominance": p = 1 - B / (R + G + B) (003 eq 1), 0.5 +- softness/3 as the soft threshold.

    Raises ValueError where no colour of the picture can be a backing.
    Source: 003 eq 1; 004 section 2.2; Vlahos 1964 (colour difference); Mishima 1992 (distance from the backing).
    Departure: 003 compares blue with a constant; cameras and curtains differ, so the backing is learnt per view.
    """
    image = np.asarray(footage.images)
    scale = max(image.shape[1] / _WIDTH, 0.25)
    if method == "blue_dominance":
        rough = _blue_dominance(image, scale, softness / 3)
    else:
        distance = _distance(image, colour, threshold, reach * scale, scale)
        rough = np.clip((distance - threshold) / (2 * softness) + 0.5, 0, 1)
    performer = performer_component(rough > 0.5, round(3 * scale), int(smallest * rough.size))
    hole = round(12 * scale**2)
    return Mattes(soft_edge(image, rough, performer, None, hole, band * scale, scale), footage.fps)


def _blue_dominance(image: np.ndarray, scale: float, half: float) -> np.ndarray:
    smooth = cv2.GaussianBlur(image.astype(np.float32), (0, 0), 0.7 * scale)
    share = 1 - smooth[..., 2] / np.maximum(smooth.sum(axis=2), 1.0)
    # half way between a pure backing (0.5) and grey (2/3)
    return np.clip((share - 0.58) / (2 * half) + 0.5, 0, 1)


def _distance(image: np.ndarray, colour: str, threshold: float, reach: float, scale: float) -> np.ndarray:
    shares, total = chromaticity(image, 0.7 * scale)
    mode = backing_mode(shares, total, colour)
    if mode is None:
        raise ValueError(
            f"chroma_key: no {'blue or green' if colour == 'auto' else colour} backing in the picture: check the "
            "footage, set colour, or use capture.background_difference"
        )
    distance = backing_distance(shares, np.broadcast_to(mode, shares.shape))
    for _ in range(2):
        weight = (distance < threshold).astype(np.float32)
        distance = backing_distance(shares, backing_field(shares, weight, mode, reach))
    return distance
