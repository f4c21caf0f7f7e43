"""How hard a motion jerks where captured pieces are joined, against how hard the capture itself does."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def frame_accelerations(vertices: np.ndarray, fps: float, quantile: float = 0.99) -> np.ndarray:
    """Acceleration of each frame (F,), m/s^2: the quantile over vertices of |x(t+1) - 2 x(t) + x(t-1)| fps^2.

    vertices: (F, V, 3), m. The first and the last frame have none: nan. quantile 1 is the peak vertex.
    """
    out = np.full(len(vertices), np.nan)
    for t in range(1, len(vertices) - 1):
        before, here, after = (vertices[k].astype(np.float64) for k in (t - 1, t, t + 1))
        out[t] = np.quantile(np.linalg.norm(after - 2.0 * here + before, axis=1), quantile) * fps**2
    return out


def join_frames(weight: np.ndarray) -> np.ndarray:
    """Which frames (F,) feel a join, by provenance weights (F, 2): blended ones and their two neighbours."""
    blended = weight[:, 1] > 0.0
    near = blended.copy()
    near[1:] |= blended[:-1]
    near[:-1] |= blended[1:]
    return near


def join_acceleration_ratio(
    vertices: np.ndarray,
    weight: np.ndarray,
    captured: Sequence[np.ndarray],
    fps: float,
    quantile: float = 0.99,
) -> float:
    """Peak acceleration at joins over the 99th percentile of the capture's frames; <= 1: joins do not show.

    vertices: (F, V, 3) synthesised; weight: (F, 2) its provenance; captured: takes (T, V, 3) it is made of.
    nan where the motion has no join.
    """
    joined = join_frames(weight)
    peak = frame_accelerations(vertices, fps, quantile)[joined]
    own = np.concatenate([frame_accelerations(take, fps, quantile) for take in captured])
    if not np.isfinite(peak).any():
        return float("nan")
    return float(np.nanmax(peak) / np.nanquantile(own, 0.99))
