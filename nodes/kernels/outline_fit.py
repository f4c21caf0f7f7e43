"""How far a surface must move along its normals so that its outlines become those of the mattes."""

from __future__ import annotations

import cv2
import numpy as np

from reperform.nodes.kernels.mesh_window import MeshWindow, at_pixels

# Pixels beyond which a gap between outlines says nothing: a limb is missing, or the matte is wrong.
_REACH = 6.0
# Pixels from the drawn outline within which a vertex makes that outline.
_RIM = 1.5
# Largest cosine between normal and viewing direction of a vertex that makes an outline.
_GRAZING = 0.6


def outline_offsets(windows: list[MeshWindow | None], alpha: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Outward moves (V,) in m and their weights (V,) from the mattes alpha (camera, y, x) uint8.

    With s the signed distance in px to an outline (positive inside): a vertex outside a matte moves inwards, by
    s_matte; a vertex that makes the drawn outline, where that lies inside the matte, moves outwards, by
    s_matte - s_drawn. One px is depth / focal length; a move along the normal shifts the outline by
    g = sqrt(1 - cos^2) of its length. Least squares over the cameras: move = sum g gap / sum g^2, weight = sum g^2.

    Source: after Vlasic, Baran, Matusik and Popovic 2008, SIGGRAPH, section 5 (surfaces fitted to silhouettes).
    """
    count = next((len(w.cosine) for w in windows if w is not None), 0)
    push, weight = np.zeros(count), np.zeros(count)
    for window, matte in zip(windows, alpha, strict=True):
        if window is None:
            continue
        height, width = window.depth.shape
        x, y = window.low
        real = at_pixels(signed_distance(matte[y : y + height, x : x + width] / 255.0), window.pixels, -99.0)
        own = at_pixels(signed_distance(np.isfinite(window.depth).astype(float)), window.pixels, -99.0)
        outside = (real < 0) & (real > -_REACH)
        makes = (np.abs(own) < _RIM) & (np.abs(window.cosine) < _GRAZING)
        short = makes & (real > own) & (real - own < _REACH)
        gap = np.where(outside, real, np.where(short, real - own, 0)) * window.range / window.focal
        gain = np.where(outside | short, np.sqrt(np.maximum(1 - window.cosine**2, 0.04)), 0)
        push += gain * gap
        weight += gain * gain
    return push / np.maximum(weight, 1e-9), weight


def signed_distance(share: np.ndarray) -> np.ndarray:
    """Distance in px (y, x) float32 to where a coverage (y, x) in 0..1 falls through 1/2; positive inside.

    Beside the edge the coverage of a pixel says where in it the edge is.
    """
    inside = (share >= 0.5).astype(np.uint8)
    distance = cv2.distanceTransform(inside, cv2.DIST_L2, 5) - cv2.distanceTransform(
        1 - inside, cv2.DIST_L2, 5
    )
    field = distance - 0.5 * np.sign(distance)
    beside = (share > 0) & (share < 1) & (np.abs(field) < 1)
    field[beside] = (share - 0.5)[beside]
    return np.asarray(field, np.float32)
