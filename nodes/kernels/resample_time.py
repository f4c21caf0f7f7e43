"""Values between frames."""

from __future__ import annotations

import numpy as np


def at_times(values: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Values (T, ...) at times (K,) in frames, by cubics through neighbouring frames; exact at whole frames.

    Beyond the ends the take goes on along a straight line.

    Source: Catmull and Rom 1974, Computer Aided Geometric Design.
    """
    if len(values) == 1:
        return np.repeat(np.asarray(values, np.float64), len(times), axis=0)
    padded = np.concatenate([2.0 * values[:1] - values[1:2], values, 2.0 * values[-1:] - values[-2:-1]])
    first = np.clip(np.floor(times + 1e-9).astype(int), 0, len(values) - 2)
    u = np.asarray(times) - first
    shares = 0.5 * np.stack(
        [-u + 2 * u**2 - u**3, 2 - 5 * u**2 + 3 * u**3, u + 4 * u**2 - 3 * u**3, u**3 - u**2], axis=1
    )
    out = np.zeros((len(times), *values.shape[1:]))
    for tap in range(4):
        out += shares[:, tap].reshape(-1, *[1] * (values.ndim - 1)) * padded[first + tap]
    return out
