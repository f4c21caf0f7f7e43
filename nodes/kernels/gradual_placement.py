"""Where two takes stand on the ground while one turns into the other, laid on each other anew in every frame."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def gradual_placement(
    source: np.ndarray, target: np.ndarray, weight: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Placements of both takes in each frame of a transition: yaw (K, 2), rad, and offset (K, 2, 2), m.

    source, target: (K, P, 3) matched poses, each in the coordinates of its take, m; weight: (K,) of the target,
    from 0 to 1. In every frame the target lies on the source by the least-squares ground-plane motion. From frame
    to frame both move on as

        (1 - w) (as the source walks) + w (as the target walks),   w the mean weight of both frames

    turn and way of the mean point apart, so that with weight 0 the source stands as captured (yaw 0, offset 0) and
    with weight 1 the target walks on from where it was brought to.

    Source: Boukhayma and Boyer 2015, 3DV (002 section 5: meshes gradually aligned, displacements of the centres of
    mass interpolated).
    """
    count = len(weight)
    yaw, offset = np.zeros((count, 2)), np.zeros((count, 2, 2))
    for k in range(count):
        turn, x, z = _lay_on(source[k], target[k])
        if k > 0:
            # the source as the target walks: the target stays put
            other = yaw[k - 1, 1] - turn
            c, s = np.cos(other), np.sin(other)
            ox = offset[k - 1, 1, 0] - (c * x + s * z)
            oz = offset[k - 1, 1, 1] - (-s * x + c * z)
            part = 0.5 * (weight[k - 1] + weight[k])
            here = yaw[k - 1, 0]
            between = here + part * _wrap(other - here)
            mx, mz = _middle(source[k])
            ax, az = _placed(mx, mz, here, offset[k - 1, 0, 0], offset[k - 1, 0, 1])
            bx, bz = _placed(mx, mz, other, ox, oz)
            px, pz = _placed(mx, mz, between, 0.0, 0.0)
            yaw[k, 0] = between
            offset[k, 0, 0] = (1.0 - part) * ax + part * bx - px
            offset[k, 0, 1] = (1.0 - part) * az + part * bz - pz
        c, s = np.cos(yaw[k, 0]), np.sin(yaw[k, 0])
        yaw[k, 1] = _wrap(yaw[k, 0] + turn)
        offset[k, 1, 0] = c * x + s * z + offset[k, 0, 0]
        offset[k, 1, 1] = -s * x + c * z + offset[k, 0, 1]
    return yaw, offset


@njit(cache=True, nogil=True)
def _lay_on(points: np.ndarray, moved: np.ndarray) -> tuple[float, float, float]:
    """Yaw and offset (x, z) that lay `moved` on `points` (P, 3) in least squares."""
    px, pz = _middle(points)
    qx, qz = _middle(moved)
    sine, cosine = 0.0, 0.0
    for i in range(len(points)):
        x, z = points[i, 0] - px, points[i, 2] - pz
        u, v = moved[i, 0] - qx, moved[i, 2] - qz
        sine += x * v - u * z
        cosine += x * u + z * v
    yaw = np.arctan2(sine, cosine)
    rx, rz = _placed(qx, qz, yaw, 0.0, 0.0)
    return yaw, px - rx, pz - rz


@njit(cache=True, nogil=True)
def _middle(points: np.ndarray) -> tuple[float, float]:
    x, z = 0.0, 0.0
    for i in range(len(points)):
        x += points[i, 0]
        z += points[i, 2]
    return x / len(points), z / len(points)


@njit(cache=True, nogil=True)
def _placed(x: float, z: float, yaw: float, ox: float, oz: float) -> tuple[float, float]:
    c, s = np.cos(yaw), np.sin(yaw)
    return c * x + s * z + ox, -s * x + c * z + oz


@njit(cache=True, nogil=True)
def _wrap(angle: float) -> float:
    return np.arctan2(np.sin(angle), np.cos(angle))
