"""How far a picture is from the picture of the empty set, shadows aside."""

from __future__ import annotations

import cv2
import numpy as np

# Saturation (1 - min / max of r, g, b) of the set from which on a shadow is told by its colour.
_SATURATED = 0.5


def plate_difference(
    image: np.ndarray, mean: np.ndarray, deviation: np.ndarray, shadow: float, blur: float
) -> np.ndarray:
    """Difference (y, x) float32 of a picture from the plate in deviations, with shadows forgiven.

    image (y, x, 3) uint8; mean, deviation (y, x, 3) float32. With E = mean / deviation and I = image / deviation,
    the brightness a = <I, E> / |E|^2 minimises |I - a E|; colour = |I - a E| and light = |1 - a| |E|, of which a
    shadow that leaves at least the share f of the light is forgiven: light counts from f down only. f is `shadow`
    where the set has a strong colour of its own and 1 where it is grey, since grey cloth on a grey wall has the
    colour of a shadow: f = 1 - (1 - shadow) min(1, saturation / 0.5). difference = sqrt(colour^2 + light^2).

    Source: Horprasert, Harwood and Davis 1999, ICCV.
    """
    steady = mean / deviation
    seen = cv2.GaussianBlur(image.astype(np.float32), (0, 0), blur) / deviation
    strength = np.maximum((steady * steady).sum(axis=2), 1.0)
    brightness = (seen * steady).sum(axis=2) / strength
    off = seen - brightness[..., None] * steady
    colour = np.sqrt((off * off).sum(axis=2))
    saturation = 1 - mean.min(axis=2) / np.maximum(mean.max(axis=2), 1.0)
    forgiven = 1 - (1 - shadow) * np.minimum(saturation / _SATURATED, 1)
    light = np.maximum(brightness - 1, 0) + np.maximum(forgiven - brightness, 0)
    return np.sqrt(colour**2 + strength * light**2)
