"""A time warp found frame by frame, made smooth enough to be played."""

from __future__ import annotations

import numpy as np

# Second differences weigh this much against the distance from the warp as found.
_STIFFNESS = 40.0


def smooth_warp(path: np.ndarray, stiffness: float = _STIFFNESS) -> np.ndarray:
    """Source and target times (K, 2), frames, along a warping path (K, 2) of whole frames.

        minimise sum_k (t_k - path_k)^2 + stiffness sum_k (t_k-1 - 2 t_k + t_k+1)^2

    with both ends kept and, of the source before the first and of the target after the last, one frame per frame:
    there the captured motion goes on unblended, so its velocity must. Times never run backwards and never leave
    the path's range. A path without stalls comes back as it is.

    Raises ValueError where the path is empty or runs backwards.
    """
    path = np.asarray(path, np.float64)
    if path.ndim != 2 or path.shape[1] != 2 or len(path) == 0 or (np.diff(path, axis=0) < 0).any():
        raise ValueError(f"smooth_warp: a path (K, 2) that never runs backwards is needed, got {path.shape}")
    if len(path) < 3:
        return path.copy()
    source = _smooth(path[:, 0], stiffness)
    target = path[-1, 1] - _smooth(path[-1, 1] - path[::-1, 1], stiffness)[::-1]
    return np.column_stack([source, target])


def _smooth(times: np.ndarray, stiffness: float) -> np.ndarray:
    """One column, its rate of one frame per frame kept at the first end."""
    count = len(times)
    bends = np.zeros((count - 1, count))
    bend = np.zeros(count - 1)
    # the frame before the first stands one frame back
    bends[0, :2], bend[0] = (-2.0, 1.0), times[0] - 1.0
    for k in range(1, count - 1):
        bends[k, k - 1 : k + 2] = (1.0, -2.0, 1.0)
    free = slice(1, count - 1)
    fixed = bends[:, 0] * times[0] + bends[:, -1] * times[-1] + bend
    matrix = np.eye(count - 2) + stiffness * bends[:, free].T @ bends[:, free]
    right = times[free] - stiffness * bends[:, free].T @ fixed
    out = times.copy()
    out[free] = np.linalg.solve(matrix, right)
    return np.clip(np.maximum.accumulate(out), times[0], times[-1])
