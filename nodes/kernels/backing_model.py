"""The backing of a chroma key, learnt from the picture itself: its chromaticity, place by place."""

from __future__ import annotations

import cv2
import numpy as np
from numba import njit

# Chromaticities (r, g) / (r + g + b); grey is (1/3, 1/3).
_GREY = np.float32(1 / 3)
_MODE_RADIUS = 0.05
_DIM = 40.0
# Pixels that the commonest colour is sought among.
_SAMPLES = 20_000


def chromaticity(image: np.ndarray, blur: float) -> tuple[np.ndarray, np.ndarray]:
    """(r, g) shares (y, x, 2) and the sum r + g + b (y, x), float32, of a picture smoothed by `blur` px."""
    return _shares(cv2.GaussianBlur(image.astype(np.float32), (0, 0), blur))


@njit(cache=True, nogil=True)
def _shares(smooth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    height, width, _ = smooth.shape
    shares = np.empty((height, width, 2), np.float32)
    total = np.empty((height, width), np.float32)
    for y in range(height):
        for x in range(width):
            whole = smooth[y, x, 0] + smooth[y, x, 1] + smooth[y, x, 2]
            total[y, x] = whole
            whole = max(whole, np.float32(1.0))
            shares[y, x, 0] = smooth[y, x, 0] / whole
            shares[y, x, 1] = smooth[y, x, 1] / whole
    return shares, total


def backing_mode(shares: np.ndarray, total: np.ndarray, colour: str) -> np.ndarray | None:
    """The commonest saturated chromaticity (2,) of a picture; None where there is no such colour.

    colour: "blue", "green" or "auto" (whichever dominates). The mode of a smoothed histogram, then mean shift.
    """
    step = max(1, int(np.sqrt(total.size / _SAMPLES)))
    samples = shares[::step, ::step].reshape(-1, 2)
    samples = samples[total[::step, ::step].ravel() > _DIM]
    red, green = samples.T
    blue = 1 - red - green
    keyed = {"blue": blue > 1.15 * np.maximum(red, green), "green": green > 1.15 * np.maximum(red, blue)}
    wanted = keyed["blue"] | keyed["green"] if colour == "auto" else keyed[colour]
    samples = samples[wanted]
    if len(samples) < 16:
        return None
    histogram, edges, _ = np.histogram2d(samples[:, 0], samples[:, 1], bins=64, range=[[0, 1], [0, 1]])
    peak = np.unravel_index(cv2.GaussianBlur(histogram, (0, 0), 1.0).argmax(), histogram.shape)
    mode = edges[list(peak)] + 0.5 / 64
    for _ in range(8):
        mode = samples[np.linalg.norm(samples - mode, axis=1) < _MODE_RADIUS].mean(axis=0)
    return mode.astype(np.float32)


def backing_field(shares: np.ndarray, weight: np.ndarray, mode: np.ndarray, reach: float) -> np.ndarray:
    """The backing's chromaticity at every pixel (y, x, 2): weighted mean of what lies within about `reach` px.

    Where no backing is near, the mode. Computed on a grid of an eighth of the resolution.
    """
    height, width = weight.shape
    small = (max(width // 8, 1), max(height // 8, 1))
    stacked = np.empty((height, width, 3), np.float32)
    np.multiply(shares, weight[..., None], out=stacked[..., :2])
    stacked[..., 2] = weight
    coarse = cv2.resize(stacked, small, interpolation=cv2.INTER_AREA)
    near = cv2.GaussianBlur(coarse, (0, 0), reach / 8)
    far = cv2.GaussianBlur(coarse, (0, 0), 4 * reach / 8)
    blended = near + 0.05 * far + np.append(mode, 1).astype(np.float32) * np.float32(1e-4)
    field = blended[..., :2] / blended[..., 2:]
    return cv2.resize(field, (width, height), interpolation=cv2.INTER_LINEAR)


@njit(cache=True, nogil=True)
def backing_distance(shares: np.ndarray, field: np.ndarray) -> np.ndarray:
    """How far each pixel's colour is from the backing's, 0 = backing, 1 = grey or as far to the side.

    With k = field - grey: along = 1 - <c - grey, k> / |k|^2, across = <c - grey, k_perp> / |k|^2; the distance
    is sqrt(max(along, 0)^2 + across^2). A deeper shade of the backing's colour (along < 0) is backing.
    """
    height, width, _ = shares.shape
    out = np.empty((height, width), np.float32)
    for y in range(height):
        for x in range(width):
            kr, kg = field[y, x, 0] - _GREY, field[y, x, 1] - _GREY
            cr, cg = shares[y, x, 0] - _GREY, shares[y, x, 1] - _GREY
            length = max(kr * kr + kg * kg, np.float32(1e-6))
            along = max(np.float32(1.0) - (cr * kr + cg * kg) / length, np.float32(0.0))
            across = (cr * kg - cg * kr) / length
            out[y, x] = np.sqrt(along * along + across * across)
    return out
