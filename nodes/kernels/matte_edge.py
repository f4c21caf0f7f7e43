"""From the region of the performer to a matte with a soft edge."""

from __future__ import annotations

import cv2
import numpy as np

from reperform.nodes.kernels.matte_refinement import refine_alpha
from reperform.nodes.kernels.performer_component import fill_small_holes

# Noise of a pixel (1/255) that the edge's colours must stand out from.
_NOISE = 4.0


def soft_edge(
    image: np.ndarray,
    rough: np.ndarray,
    performer: np.ndarray,
    backing: np.ndarray | None,
    hole: int,
    band: float,
    scale: float,
) -> np.ndarray:
    """Alpha (y, x) uint8 of the performer's region, soft within `band` px of its edge.

    image (y, x, 3) uint8; rough (y, x) float32 coverage by colour alone; performer (y, x) bool; backing
    (y, x, 3): the colour behind, if known. Holes of at most `hole` px are filled.
    """
    alpha = np.zeros(performer.shape, np.uint8)
    if not performer.any():
        return alpha
    window = _window(performer, round(12 * scale))
    # an edge is never thinner than a pixel
    width = 2 * max(round(band), 1) + 1
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (width, width))
    solid = fill_small_holes(performer[window], hole).astype(np.uint8)
    core = cv2.erode(solid, disc)
    inside = (core > 0) & ((rough[window] >= 1) | (cv2.erode(core, disc) > 0))
    outside = cv2.dilate(solid, disc) == 0
    behind = None if backing is None else backing[window]
    soft = refine_alpha(
        image[window].astype(np.float32), inside, outside, rough[window], behind, max(3 * scale, 2.0), _NOISE
    )
    alpha[window] = np.round(255 * soft).astype(np.uint8)
    return alpha


def _window(mask: np.ndarray, margin: int) -> tuple[slice, slice]:
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return (
        slice(max(rows[0] - margin, 0), rows[-1] + margin + 1),
        slice(max(columns[0] - margin, 0), columns[-1] + margin + 1),
    )
