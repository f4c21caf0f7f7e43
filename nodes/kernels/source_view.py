"""A captured picture made ready to texture from: cropped, with depth and with how far it can be trusted."""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np

from reperform.nodes.kernels.camera import project
from reperform.nodes.kernels.rasterise import rasterise

# Trust just inside the eroded rim: used where no other camera sees a point.
RIM = 0.02


class SourceView(NamedTuple):
    """One camera's picture of the performer, cropped around the mesh."""

    image: np.ndarray  # (h, w, 3) uint8
    depth: np.ndarray  # (h, w) float32, m; inf = the mesh is not there
    trust: np.ndarray  # (h, w) float32 in 0..1
    origin: np.ndarray  # (2,) float64: x, y of the crop's first pixel
    matrix: np.ndarray
    rotation: np.ndarray
    translation: np.ndarray
    distortion: np.ndarray


def source_view(
    image: np.ndarray,
    alpha: np.ndarray,
    vertices: np.ndarray,
    faces: np.ndarray,
    camera: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray],
    *,
    erode: float = 1.5,
    feather: float = 6.0,
) -> SourceView | None:
    """Crop one picture around the mesh and grade its pixels; None where the mesh is out of the picture.

    image (H, W, 3) uint8, alpha (H, W) uint8; camera: matrix, rotation, translation, distortion. A pixel is
    unsafe where the mesh is not seen, where alpha < 0.9, or beside a jump of depth (there the picture may
    show the other side of it): where the second difference of depth along x or y exceeds 2 cm + two pixels'
    footprint, depth / focal length. With d the distance in px to the nearest unsafe pixel:
    trust = 0 up to d = erode, then 0.02 + 0.98 smoothstep((d - erode) / feather).

    Source: Debevec, Taylor and Malik 1996, SIGGRAPH, section 4 (visibility, blending near borders);
    Buehler et al. 2001, SIGGRAPH, section 3 (feathering at boundaries).
    """
    height, width = alpha.shape
    pixels, depth = project(vertices, *camera)
    seen = np.isfinite(pixels).all(axis=1)
    if not seen.any():
        return None
    margin = 2
    low = np.maximum(np.floor(pixels[seen].min(axis=0)).astype(int) - margin, 0)
    high = np.minimum(np.ceil(pixels[seen].max(axis=0)).astype(int) + margin + 1, (width, height))
    if (high <= low).any():
        return None
    window = slice(low[1], high[1]), slice(low[0], high[0])
    _, _, buffer = rasterise(pixels - low, depth, faces, high[1] - low[1], high[0] - low[0])
    safe = np.isfinite(buffer) & (alpha[window] >= 0.9 * 255) & ~_jumps(buffer, float(camera[0][0, 0]))
    # Beyond the picture's border nothing is known.
    distance = cv2.distanceTransform(np.pad(safe, 1).astype(np.uint8), cv2.DIST_L2, 5)[1:-1, 1:-1]
    ramp = np.clip((distance - erode) / feather, 0, 1)
    trust = np.where(distance > erode, RIM + (1 - RIM) * ramp * ramp * (3 - 2 * ramp), 0).astype(np.float32)
    return SourceView(
        np.ascontiguousarray(image[window]),
        buffer,
        trust,
        low.astype(np.float64),
        *(np.ascontiguousarray(part, np.float64) for part in camera),
    )


def _jumps(depth: np.ndarray, focal: float) -> np.ndarray:
    """Pixels at a step of depth; a steady slope is none, and an unseen neighbour does not count."""
    finite = np.isfinite(depth)
    padded = np.pad(np.where(finite, depth, np.nan), 1, constant_values=np.nan)
    middle = padded[1:-1, 1:-1]
    bend_x = np.abs(padded[1:-1, :-2] - 2 * middle + padded[1:-1, 2:])
    bend_y = np.abs(padded[:-2, 1:-1] - 2 * middle + padded[2:, 1:-1])
    limit = 0.02 + 2 * middle / focal
    jumps: np.ndarray = (bend_x > limit) | (bend_y > limit)
    return jumps
