"""Unit quaternions (w, x, y, z) for compiled loops: one rotation at a time, written into the caller's array."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def from_matrix(r: np.ndarray, q: np.ndarray) -> None:
    """The quaternion q (4,) of a rotation matrix r (3, 3)."""
    trace = r[0, 0] + r[1, 1] + r[2, 2]
    if trace > 0.0:
        q[0] = 1.0 + trace
        q[1], q[2], q[3] = r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]
    else:
        i = 0
        if r[1, 1] > r[0, 0]:
            i = 1
        if r[2, 2] > r[i, i]:
            i = 2
        j, k = (i + 1) % 3, (i + 2) % 3
        q[0] = r[k, j] - r[j, k]
        q[1 + i] = 1.0 + r[i, i] - r[j, j] - r[k, k]
        q[1 + j], q[1 + k] = r[j, i] + r[i, j], r[k, i] + r[i, k]
    norm = np.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2 + q[3] ** 2)
    for k in range(4):
        q[k] /= norm


@njit(cache=True, nogil=True)
def to_matrix(q: np.ndarray, r: np.ndarray) -> None:
    """The rotation matrix r (3, 3) of a quaternion q (4,)."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    r[0, 0], r[0, 1], r[0, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    r[1, 0], r[1, 1], r[1, 2] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
    r[2, 0], r[2, 1], r[2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)


@njit(cache=True, nogil=True)
def multiply(p: np.ndarray, q: np.ndarray, out: np.ndarray) -> None:
    """out = p q: first q, then p."""
    out[0] = p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3]
    out[1] = p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2]
    out[2] = p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1]
    out[3] = p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]


@njit(cache=True, nogil=True)
def from_vector(v: np.ndarray, scale: float, q: np.ndarray) -> None:
    """The quaternion q (4,) of the rotation vector scale v (3,), radians."""
    angle = np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    half = 0.5 * scale * angle
    share = 0.5 * scale if angle < 1e-12 else np.sin(half) / angle
    q[0] = np.cos(half)
    for k in range(3):
        q[k + 1] = share * v[k]


@njit(cache=True, nogil=True)
def between(first: np.ndarray, second: np.ndarray, out: np.ndarray) -> None:
    """The rotation vector out (3,) of first^-1 second, angle in [0, pi]."""
    w = first[0] * second[0] + first[1] * second[1] + first[2] * second[2] + first[3] * second[3]
    x = first[0] * second[1] - first[1] * second[0] - first[2] * second[3] + first[3] * second[2]
    y = first[0] * second[2] + first[1] * second[3] - first[2] * second[0] - first[3] * second[1]
    z = first[0] * second[3] - first[1] * second[2] + first[2] * second[1] - first[3] * second[0]
    sign = -1.0 if w < 0.0 else 1.0
    sine = np.sqrt(x * x + y * y + z * z)
    scale = 2.0 * sign if sine < 1e-12 else 2.0 * sign * np.arctan2(sine, sign * w) / sine
    out[0], out[1], out[2] = scale * x, scale * y, scale * z
