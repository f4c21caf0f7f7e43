"""A mesh seen by one camera with several samples per pixel: which surface point each sample hits."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.camera import project
from reperform.nodes.kernels.rasterise import rasterise


class Samples(NamedTuple):
    """The samples of a block of pixels that holds the whole mesh: first row and column, samples per pixel
    edge, face hit ids (h * s, w * s) with -1 = none, barycentric (h * s, w * s, 3).
    """

    top: int
    left: int
    per_edge: int
    ids: np.ndarray
    barycentric: np.ndarray

    @property
    def block(self) -> tuple[slice, slice]:
        """The block's place in the picture."""
        height, width = (length // self.per_edge for length in self.ids.shape)
        return slice(self.top, self.top + height), slice(self.left, self.left + width)


def sample_view(
    vertices: np.ndarray,
    faces: np.ndarray,
    matrix: np.ndarray,
    rotation: np.ndarray,
    translation: np.ndarray,
    distortion: np.ndarray,
    image_size: np.ndarray,
    per_edge: int,
) -> Samples:
    """Samples of a picture of image_size (width, height): per_edge^2 in a regular grid in every pixel.

    Sample (i, j) of pixel (y, x) lies at (x + (j + 0.5) / s - 0.5, y + (i + 0.5) / s - 0.5).
    """
    width, height = (int(value) for value in image_size)
    pixels, depth = project(vertices, matrix, rotation, translation, distortion)
    seen = pixels[np.isfinite(pixels).all(axis=1) & (depth > 0)]
    if not len(seen):
        return Samples(0, 0, per_edge, np.full((0, 0), -1, np.int32), np.zeros((0, 0, 3), np.float32))
    low = np.clip(np.floor(seen.min(axis=0) - 1), 0, (width, height)).astype(int)
    high = np.clip(np.ceil(seen.max(axis=0) + 2), 0, (width, height)).astype(int)
    size = np.maximum(high - low, 0)
    fine = (pixels - low + 0.5) * per_edge - 0.5
    ids, barycentric, _ = rasterise(fine, depth, faces, int(size[1]) * per_edge, int(size[0]) * per_edge)
    return Samples(int(low[1]), int(low[0]), per_edge, ids, barycentric)


def pixel_mean(values: np.ndarray, per_edge: int) -> np.ndarray:
    """Mean over the samples of each pixel: (h * s, w * s, ...) -> (h, w, ...), float32."""
    height, width = values.shape[0] // per_edge, values.shape[1] // per_edge
    total = np.zeros((height, width, *values.shape[2:]), np.float32)
    for i in range(per_edge):
        for j in range(per_edge):
            total += values[i::per_edge, j::per_edge]
    return total / np.float32(per_edge * per_edge)


def coverage(samples: Samples, image_size: np.ndarray) -> np.ndarray:
    """Share of each pixel (height, width) that the mesh covers, float32 in [0, 1]."""
    alpha = np.zeros((int(image_size[1]), int(image_size[0])), np.float32)
    if samples.ids.size:
        alpha[samples.block] = pixel_mean((samples.ids >= 0).astype(np.float32), samples.per_edge)
    return alpha
