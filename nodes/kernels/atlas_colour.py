"""Colours of the faces of a mesh in the picture painted on it."""

from __future__ import annotations

import numpy as np


def face_colours(uv: np.ndarray, faces_uv: np.ndarray, image: np.ndarray, samples: int) -> np.ndarray:
    """Mean colour (face, 3) float64, in the units of the image (H, W, 3), over samples^2 equal parts of each face.

    uv (N, 2), u right, v up; faces_uv (face, 3). The pixel that holds the middle of a part is read.
    """
    height, width = image.shape[:2]
    total = np.zeros((len(faces_uv), 3))
    for weights in part_centres(samples):
        u, v = np.einsum("c,fck->kf", weights, uv[faces_uv].astype(np.float64))
        x = np.clip(np.floor(u * width), 0, width - 1).astype(int)
        y = np.clip(np.floor((1 - v) * height), 0, height - 1).astype(int)
        total += image[y, x]
    return total / samples**2


def part_centres(samples: int) -> np.ndarray:
    """Barycentric coordinates (samples^2, 3) of the middles of the equal parts that cut each edge in `samples`."""
    found = []
    for i in range(samples):
        for j in range(2 * (samples - i) - 1):
            # odd parts point the other way
            third = 2 / 3 if j % 2 else 1 / 3
            p, q = (i + third) / samples, (j // 2 + third) / samples
            found.append((p, q, 1 - p - q))
    return np.array(found)
