"""Secondary motion of a loose garment: a lattice of damped springs that lags behind the body that carries
it.
"""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def lag(
    targets: np.ndarray, looseness: np.ndarray, step: float, frequency: float, damping: float, drag: float
) -> np.ndarray:
    """Displacement e (N, P, 3) of lattice points from where the body carries them, targets (N, P, 3),
    uniform steps (s).

    e'' = -a - 2 z w (e' + d v) - w^2 e, with a and v the target's acceleration and velocity, w = 2 pi
    frequency (Hz), z = damping ratio, d = drag (the air's share of it). Semi-implicit Euler. The answer is
    scaled by the looseness (P,) in [0, 1] and bounded smoothly at 0.16 m.
    """
    count, points = targets.shape[0], targets.shape[1]
    offset = np.zeros((count, points, 3))
    omega = 2 * np.pi * frequency
    limit = 0.16
    e = np.zeros((points, 3))
    rate = np.zeros((points, 3))
    for n in range(1, count):
        after = min(n + 1, count - 1)
        for p in range(points):
            for d in range(3):
                velocity = (targets[after, p, d] - targets[n - 1, p, d]) / ((after - n + 1) * step)
                pull = 0.0
                if after > n:
                    pull = (targets[after, p, d] - 2 * targets[n, p, d] + targets[n - 1, p, d]) / (
                        step * step
                    )
                if d == 1:
                    pull *= 0.5
                    velocity *= 0.5
                force = -pull - 2 * damping * omega * (rate[p, d] + drag * velocity) - omega * omega * e[p, d]
                rate[p, d] += step * force
                e[p, d] += step * rate[p, d]
            size = np.sqrt(e[p, 0] ** 2 + e[p, 1] ** 2 + e[p, 2] ** 2) * looseness[p]
            scale = looseness[p] / (1.0 + size / limit)
            for d in range(3):
                offset[n, p, d] = e[p, d] * scale
    return offset


@njit(cache=True, nogil=True)
def push_out(
    points: np.ndarray, centre: np.ndarray, starts: np.ndarray, ends: np.ndarray, radii: np.ndarray
) -> np.ndarray:
    """Points (N, P, 3) moved out of the capsules starts-ends (N, C, 3) with radii (C, 2) at start and end.

    A point inside goes straight away from the nearest point of the capsule's axis, but never inwards past
    `centre` (N, 3), the axis of the garment: what is pushed goes outwards.
    """
    moved = points.copy()
    for n in range(points.shape[0]):
        for c in range(starts.shape[1]):
            axis = ends[n, c] - starts[n, c]
            length = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]
            for p in range(points.shape[1]):
                offset = moved[n, p] - starts[n, c]
                t = (offset[0] * axis[0] + offset[1] * axis[1] + offset[2] * axis[2]) / length
                t = min(max(t, 0.0), 1.0)
                radius = radii[c, 0] + t * (radii[c, 1] - radii[c, 0])
                away = offset - t * axis
                outward = moved[n, p] - centre[n]
                outward[1] = 0.0
                outward /= max(np.sqrt(outward[0] ** 2 + outward[2] ** 2), 1e-6)
                lean = away[0] * outward[0] + away[2] * outward[2]
                if lean < 0:
                    # the far side of the leg: measure from its outer wall
                    away = away - 2 * lean * outward
                    inside = radius - lean
                else:
                    inside = radius
                distance = np.sqrt(away[0] ** 2 + away[1] ** 2 + away[2] ** 2)
                depth = inside - distance
                if lean < 0 and np.sqrt(max(distance**2 - lean * lean, 0.0)) > radius:
                    depth = 0.0
                if depth > 0:
                    for d in range(3):
                        moved[n, p, d] += depth * outward[d]
    return moved
