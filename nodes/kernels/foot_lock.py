"""Holding planted feet still while a motion is being made: only the past is known."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

# A foot counts as planted from this share of what is blended.
_DOWN = 0.95
# A foot that would have to be held further from where the motion has it (m) is let go.
_FAR = 0.22
# Legs give this much (m) before the root is drawn after the feet.
_SLACK = 0.05


class FootLock(NamedTuple):
    """State per foot: whether it is held, by how much the motion is shifted there, and how fast that changes."""

    held: np.ndarray
    shift: np.ndarray
    rate: np.ndarray


def new_lock(feet: int) -> FootLock:
    """Nothing is held."""
    return FootLock(np.zeros(feet, np.bool_), np.zeros((feet, 3)), np.zeros((feet, 3)))


@njit(cache=True, nogil=True)
def lock_feet(
    slid: np.ndarray, share: np.ndarray, lock: FootLock, dt: float, ease: float, pull: float, root: np.ndarray
) -> None:
    """Update the shifts so that planted feet stand still, and let the root follow them.

    slid (K, 2): how far the motion slid over the ground where each sole touches it, x, z, m; share (K,): how much of
    what is blended has it planted; root (3,): x, z, yaw, moved by what holding the feet asks for beyond what legs give,
    within about `pull` s.

        held: shift -= slid;   free: shift'' = -2 w shift' - w^2 shift, w = 2 / ease

    A shift goes on as it was where a foot is put down or let go, so positions never jump. Heights are left alone.

    Source: Kovar, Schreiner and Gleicher 2002, SCA (footskate clean-up). Departure: on line, with a critically damped
    release in place of a look ahead, what touches held in place of a joint, and the root drawn after the feet.
    """
    w = 2.0 / ease
    count, mean_x, mean_z = 0, 0.0, 0.0
    for k in range(len(slid)):
        planted = share[k] >= _DOWN
        # a foot that is put down rests from here on
        x, z = lock.shift[k, 0], lock.shift[k, 2]
        if lock.held[k]:
            x, z = x - slid[k, 0], z - slid[k, 1]
        lock.held[k] = planted and x * x + z * z <= _FAR * _FAR
        if lock.held[k]:
            lock.rate[k, 0], lock.rate[k, 2] = (x - lock.shift[k, 0]) / dt, (z - lock.shift[k, 2]) / dt
            lock.shift[k, 0], lock.shift[k, 2] = x, z
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
        mean_x, mean_z = mean_x / count, mean_z / count
        far = np.sqrt(mean_x * mean_x + mean_z * mean_z)
        if far > _SLACK:
            gain = (1.0 - np.exp(-dt / pull)) * (1.0 - _SLACK / far)
            root[0] += gain * mean_x
            root[1] += gain * mean_z
