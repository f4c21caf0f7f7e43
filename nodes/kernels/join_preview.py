"""What a transition would look like, foreseen on a few points: its placement and how hard it would jerk."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def preview_join(
    source: np.ndarray,
    target: np.ndarray,
    m: int,
    n: int,
    half: int,
    point_weight: np.ndarray,
    captured: np.ndarray,
    enough: float,
) -> tuple[float, float, float, float]:
    """Placement (yaw, offset x, offset z) of the target, and how hard the blend jerks against the capture.

    source, target: (frames, P, 3) the same points of two takes, m; frames m - half .. m + half are blended
    into n - half .. n + half; point_weight: (P,).
    captured: what `captured_acceleration` says of the takes; enough: a jerk above it comes back as inf.
    The placement is the least-squares one of the whole window with weights (half - |k|) point_weight. The
    jerk is the greatest ratio of the blend's acceleration to the captured one, over the frames of the window
    and one on either side, of the median point (the body) and of the 99th percentile (its quickest part).
    """
    yaw, x, z = _place(source, target, m, n, half, point_weight)
    first = -half - min(2, m - half)
    last = half + min(2, len(target) - 1 - n - half)
    count = source.shape[1]
    middle, high = count // 2, int(np.ceil(0.99 * (count - 1)))
    blend, square, peak = np.empty((3, count, 3)), np.empty(count), 0.0
    for k in range(first, last + 1):
        _blend(source, target, m + k, n + k, (k + half) / (2.0 * half), yaw, x, z, blend[k % 3])
        if k < first + 2:
            continue
        for i in range(count):
            square[i] = 0.0
            for axis in range(3):
                a = blend[k % 3, i, axis] - 2.0 * blend[(k - 1) % 3, i, axis] + blend[(k - 2) % 3, i, axis]
                square[i] += a * a
        square.sort()
        peak = max(peak, square[middle] / captured[0] ** 2, square[high] / captured[1] ** 2)
        if peak > enough * enough:
            return yaw, x, z, np.inf
    return yaw, x, z, np.sqrt(peak)


@njit(cache=True, nogil=True)
def _blend(
    source: np.ndarray,
    target: np.ndarray,
    one: int,
    other: int,
    u: float,
    yaw: float,
    x: float,
    z: float,
    out: np.ndarray,
) -> None:
    c, s = np.cos(yaw), np.sin(yaw)
    u = min(max(u, 0.0), 1.0)
    w = u * u * (3.0 - 2.0 * u)
    for i in range(len(out)):
        for axis in range(3):
            out[i, axis] = (1.0 - w) * source[one, i, axis] if w < 1.0 else 0.0
        if w > 0.0:
            px, pz = target[other, i, 0], target[other, i, 2]
            out[i, 0] += w * (c * px + s * pz + x)
            out[i, 1] += w * target[other, i, 1]
            out[i, 2] += w * (-s * px + c * pz + z)


@njit(cache=True, nogil=True)
def _place(
    source: np.ndarray, target: np.ndarray, m: int, n: int, half: int, point_weight: np.ndarray
) -> tuple[float, float, float]:
    total, ax, az, bx, bz = 0.0, 0.0, 0.0, 0.0, 0.0
    dot, cross = 0.0, 0.0
    for k in range(1 - half, half):
        for i in range(source.shape[1]):
            w = (half - abs(k)) * point_weight[i]
            px, pz = source[m + k, i, 0], source[m + k, i, 2]
            qx, qz = target[n + k, i, 0], target[n + k, i, 2]
            total += w
            ax += w * px
            az += w * pz
            bx += w * qx
            bz += w * qz
            dot += w * (px * qx + pz * qz)
            cross += w * (px * qz - pz * qx)
    dot -= (ax * bx + az * bz) / total
    cross -= (ax * bz - az * bx) / total
    yaw = np.arctan2(cross, dot) if np.hypot(cross, dot) > 1e-12 * total else 0.0
    c, s = np.cos(yaw), np.sin(yaw)
    return yaw, (ax - c * bx - s * bz) / total, (az + s * bx - c * bz) / total


def captured_acceleration(takes: list[np.ndarray]) -> np.ndarray:
    """How hard the capture (frames, P, 3) itself accelerates: (2,), m per frame^2.

    The 99th percentile over all frames of the median and of the 99th percentile over points; a nanometre
    where nothing moves.
    """
    own = [
        np.quantile(np.linalg.norm(np.diff(points, n=2, axis=0), axis=2), [0.5, 0.99], axis=1)
        for points in takes
        if len(points) > 2
    ]
    peaks = np.quantile(np.concatenate(own, axis=1), 0.99, axis=1) if own else np.zeros(2)
    return np.maximum(peaks, 1e-9)
