"""Colour of a textured, lit surface, averaged over the samples of every pixel."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def shade_samples(
    ids: np.ndarray,
    barycentric: np.ndarray,
    faces: np.ndarray,
    faces_uv: np.ndarray,
    uv: np.ndarray,
    image: np.ndarray,
    light: np.ndarray,
    veil: np.ndarray,
    veil_colour: np.ndarray,
    per_edge: int,
) -> tuple[np.ndarray, np.ndarray]:
    """Premultiplied colour (h, w, 3) and coverage (h, w) of the pixels of a block, float32, colours in
    image units.

    ids (h s, w s) and barycentric (h s, w s, 3): the samples, s = per_edge; uv (N, 2) into image (H, W, 3),
    read bilinearly; light and veil (V,) at vertices. A sample is texture * light * (1 - veil) + veil *
    veil_colour.
    """
    height, width = ids.shape[0] // per_edge, ids.shape[1] // per_edge
    rows, columns = image.shape[0], image.shape[1]
    colour = np.zeros((height, width, 3), np.float32)
    alpha = np.zeros((height, width), np.float32)
    share = np.float32(1.0 / (per_edge * per_edge))
    for i in range(ids.shape[0]):
        y = i // per_edge
        for j in range(ids.shape[1]):
            f = ids[i, j]
            if f < 0:
                continue
            x = j // per_edge
            u = v = np.float32(0)
            bright = haze = np.float32(0)
            for k in range(3):
                b = barycentric[i, j, k]
                corner, texel = faces[f, k], faces_uv[f, k]
                bright += b * light[corner]
                haze += b * veil[corner]
                u += b * uv[texel, 0]
                v += b * uv[texel, 1]
            px = min(max(u * columns - np.float32(0.5), np.float32(0)), np.float32(columns - 1))
            py = min(max((1 - v) * rows - np.float32(0.5), np.float32(0)), np.float32(rows - 1))
            x0, y0 = int(px), int(py)
            x1, y1 = min(x0 + 1, columns - 1), min(y0 + 1, rows - 1)
            fx, fy = px - x0, py - y0
            bright *= 1 - haze
            for c in range(3):
                top = image[y0, x0, c] * (1 - fx) + image[y0, x1, c] * fx
                bottom = image[y1, x0, c] * (1 - fx) + image[y1, x1, c] * fx
                colour[y, x, c] += share * ((top * (1 - fy) + bottom * fy) * bright + haze * veil_colour[c])
            alpha[y, x] += share
    return colour, alpha
