"""Which surface point each output pixel shows, with antialiased coverage."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.rasterise import rasterise


class SurfaceHits(NamedTuple):
    """The P pixels that show the mesh: where they are, what they show, and how much of each pixel is
    covered."""

    y: np.ndarray  # (P,) int
    x: np.ndarray  # (P,) int
    ids: np.ndarray  # (P,) int32 triangle
    barycentric: np.ndarray  # (P, 3) float32
    coverage: np.ndarray  # (P,) float32 in (0, 1]


def surface_hits(
    pixels: np.ndarray, depth: np.ndarray, faces: np.ndarray, height: int, width: int, samples: int = 3
) -> SurfaceHits:
    """Rasterise with samples x samples points per pixel.

    A pixel's coverage is the share of its points that hit the mesh; it shows the hit nearest its centre (for
    odd `samples` the centre itself where that is covered). pixels (V, 2), depth (V,), faces (F, 3) as in
    `rasterise`.
    """
    usable = (depth > 0) & np.isfinite(pixels).all(axis=1)
    empty = SurfaceHits(
        *(np.zeros(0, int),) * 2, np.zeros(0, np.int32), np.zeros((0, 3), np.float32), np.zeros(0, np.float32)
    )
    if not usable.any():
        return empty
    low = np.maximum(np.floor(pixels[usable].min(axis=0)).astype(int), 0)
    high = np.minimum(np.ceil(pixels[usable].max(axis=0)).astype(int) + 1, (width, height))
    if (high <= low).any():
        return empty
    columns, rows = high - low
    fine = (pixels - low) * samples + (samples - 1) / 2
    ids, barycentric, _ = rasterise(fine, depth, faces, rows * samples, columns * samples)
    blocks = ids.reshape(rows, samples, columns, samples).transpose(0, 2, 1, 3).reshape(rows, columns, -1)
    covered = blocks >= 0
    coverage = covered.mean(axis=-1, dtype=np.float32)
    y, x = np.nonzero(coverage)
    order = _nearest_first(samples)
    best = order[np.argmax(covered[y, x][:, order], axis=1)]
    fine_y, fine_x = y * samples + best // samples, x * samples + best % samples
    return SurfaceHits(
        y + low[1], x + low[0], ids[fine_y, fine_x], barycentric[fine_y, fine_x], coverage[y, x]
    )


def _nearest_first(samples: int) -> np.ndarray:
    """Sample numbers (row-major) from the pixel's centre outwards."""
    offset = np.arange(samples) - (samples - 1) / 2
    return np.argsort((offset[:, None] ** 2 + offset**2).ravel(), kind="stable")
