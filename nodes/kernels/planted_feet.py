"""Which feet rest on the ground, judged from how they move."""

from __future__ import annotations

import numpy as np


def planted_feet(feet: np.ndarray, fps: float, height: float = 0.05, speed: float = 0.45) -> np.ndarray:
    """(T, 2) bool: foot joints (T, 2, 3) that are within `height` (m) of their lowest and slower than `speed` (m/s).

    Speeds are central differences.
    """
    if len(feet) == 1:
        velocity = np.zeros_like(feet)
    else:
        velocity = np.gradient(feet.astype(float), 1 / fps, axis=0)
    low = feet[..., 1] < feet[..., 1].min(axis=0) + height
    return np.asarray(low & (np.linalg.norm(velocity, axis=-1) < speed))
