"""Sensor noise that depends on nothing but the seed and the pixel's place."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def expose(light: np.ndarray, tint: np.ndarray, deviation: float, seed: int) -> np.ndarray:
    """8-bit picture (H, W, 3) of light (H, W, 3) (1/255) times channel gains tint (3,), with noise.

    Noise has mean 0 and deviation `deviation` sqrt(0.2 + 0.8 I / 255): read noise plus shot noise. It is
    the sum of four uniform numbers (within 1 % of a normal one up to 2.5 deviations, never beyond 3.5),
    drawn by splitmix64 of seed and place, so that no order of work can change it.

    Source: Steele, Lea, Flood 2014, OOPSLA (splitmix64); Foi et al. 2008, IEEE TIP 17(10) (noise that grows
    with the signal).
    """
    height, width = light.shape[0], light.shape[1]
    picture = np.empty((height, width, 3), np.uint8)
    # variance of a sum of four uniforms on [0, 65535] is 4 * 65536^2 / 12
    unit = np.float32(1.0 / np.sqrt(4.0 * (65536.0**2 - 1.0) / 12.0))
    strength = np.float32(deviation)
    place = np.uint64(0)
    base = np.uint64(seed)
    golden = np.uint64(0x9E3779B97F4A7C15)
    mask = np.uint64(0xFFFF)
    for y in range(height):
        for x in range(width):
            for c in range(3):
                place += np.uint64(1)
                z = base + place * golden
                z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
                z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
                z = z ^ (z >> np.uint64(31))
                total = np.int64(z & mask) + np.int64((z >> np.uint64(16)) & mask)
                total += np.int64((z >> np.uint64(32)) & mask) + np.int64(z >> np.uint64(48))
                value = min(max(light[y, x, c] * tint[c], np.float32(0)), np.float32(255))
                sigma = strength * np.sqrt(np.float32(0.2) + np.float32(0.8 / 255) * value)
                value += sigma * unit * np.float32(total - 131070)
                picture[y, x, c] = np.uint8(min(max(value, np.float32(0)), np.float32(255)) + np.float32(0.5))
    return picture
