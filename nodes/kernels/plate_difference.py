"""How far a picture is from the picture of the empty set, shadows aside."""

from __future__ import annotations

import cv2
import numpy as np


def plate_difference(
    image: np.ndarray, mean: np.ndarray, deviation: np.ndarray, shadow: float, blur: float
) -> np.ndarray:
    """Difference (y, x) float32 of a picture from the plate in deviations, with shadows forgiven.

    image (y, x, 3) uint8; mean, deviation (y, x, 3) float32. With E = mean / deviation and I = image / deviation,
    the brightness a = <I, E> / |E|^2 minimises |I - a E|; colour = |I - a E| and light = |a - 1| |E|. A pixel with
    shadow <= a <= 1 is allowed to be dark: its light counts only as far as a lies under `shadow`, and its colour is
    taken in the deviation of the shadow itself. difference = sqrt(colour^2 + light^2 / 4).

    Source: Horprasert, Harwood and Davis 1999, ICCV.
    """
    steady = mean / deviation
    seen = cv2.GaussianBlur(image.astype(np.float32), (0, 0), blur) / deviation
    strength = np.maximum((steady * steady).sum(axis=2), 1.0)
    brightness = (seen * steady).sum(axis=2) / strength
    off = seen - brightness[..., None] * steady
    colour = np.sqrt((off * off).sum(axis=2))
    excess = np.where(
        brightness > 1,
        brightness - 1,
        np.where(brightness < shadow, (shadow - brightness) / max(shadow, 0.1), 0),
    )
    light = excess * np.sqrt(strength)
    return np.sqrt(colour**2 + 0.25 * light**2)
