"""Holding planted feet still while a motion is being made: only the past is known."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

# A foot counts as planted from this share of what is blended, and until under the other.
_DOWN, _UP = 0.95, 0.9
# A foot that would have to be held further from where the motion has it (m) is let go.
_FAR = 0.22


class FootLock(NamedTuple):
    """State per foot: whether it is held, where, by how much the motion is shifted there, and how fast that changes."""

    held: np.ndarray
    place: np.ndarray
    shift: np.ndarray
    rate: np.ndarray


def new_lock(feet: int) -> FootLock:
    """Nothing is held."""
    return FootLock(np.zeros(feet, np.bool_), np.zeros((feet, 3)), np.zeros((feet, 3)), np.zeros((feet, 3)))


@njit(cache=True, nogil=True)
def lock_feet(
    sole: np.ndarray, share: np.ndarray, lock: FootLock, dt: float, ease: float, pull: float, root: np.ndarray
) -> None:
    """Update the shifts so that planted feet stand still, and let the root follow them.

    sole (K, 3): where the motion has each sole, m; share (K,): how much of what is blended has it planted; root (3,):
    x, z, yaw, moved by what holding the feet asks for, within about `pull` s.

        held: shift = place - sole;   free: shift'' = -2 w shift' - w^2 shift, w = 2 / ease

    A shift goes on as it was where a foot is put down or let go, so positions never jump. Heights are left alone.

    Source: Kovar, Schreiner and Gleicher 2002, SCA (footskate clean-up). Departure: on line, with a critically damped
    release in place of a look ahead, and the root drawn after the feet.
    """
    w = 2.0 / ease
    count, mean_x, mean_z = 0, 0.0, 0.0
    for k in range(len(sole)):
        planted = share[k] >= (_UP if lock.held[k] else _DOWN)
        if planted and not lock.held[k]:
            for axis in range(3):
                lock.place[k, axis] = sole[k, axis] + lock.shift[k, axis]
        if planted:
            dx, dz = lock.place[k, 0] - sole[k, 0], lock.place[k, 2] - sole[k, 2]
            planted = dx * dx + dz * dz <= _FAR * _FAR
        lock.held[k] = planted
        if planted:
            for axis in (0, 2):
                shift = lock.place[k, axis] - sole[k, axis]
                lock.rate[k, axis] = (shift - lock.shift[k, axis]) / dt
                lock.shift[k, axis] = shift
            count += 1
            mean_x += lock.shift[k, 0]
            mean_z += lock.shift[k, 2]
        else:
            fall = np.exp(-w * dt)
            for axis in (0, 2):
                # the exact solution of the damped spring over dt
                b = lock.rate[k, axis] + w * lock.shift[k, axis]
                shift = (lock.shift[k, axis] + b * dt) * fall
                lock.rate[k, axis] = (lock.rate[k, axis] - w * b * dt) * fall
                lock.shift[k, axis] = shift
    if count:
        gain = 1.0 - np.exp(-dt / pull)
        root[0] += gain * mean_x / count
        root[1] += gain * mean_z / count
