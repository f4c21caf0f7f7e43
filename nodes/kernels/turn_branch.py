"""Rotation vectors of neighbouring faces on one branch, so that what turns past half a turn stays whole."""

from __future__ import annotations

import numpy as np
from numba import njit

from reperform.nodes.kernels.quaternion import between

# Neighbouring faces whose rotations differ by less than this are sure of their branch, radians.
_ALIKE = 0.5


@njit(cache=True, nogil=True)
def relative_turns(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Rotation vectors of first^-1 second, angle in [0, pi], (F, 3); first, second: unit quaternions (F, 4)."""
    out = np.empty((len(first), 3))
    for f in range(len(first)):
        between(first[f], second[f], out[f])
    return out


@njit(cache=True, nogil=True)
def nearest_branch(turn: np.ndarray, f: int, guide: np.ndarray, g: int) -> float:
    """Move turn[f] to the branch, axis (angle + 2 pi k), nearest to guide[g]; returns how far they are then apart.

    Branches beyond three quarters of a turn are left alone: there the axis is noise.
    """
    angle, along = 0.0, 0.0
    for k in range(3):
        angle += turn[f, k] * turn[f, k]
        along += turn[f, k] * guide[g, k]
    angle = np.sqrt(angle)
    if angle > 1e-9:
        turns = np.round((along / angle - angle) / (2 * np.pi))
        if turns != 0.0 and abs(angle + 2 * np.pi * turns) < 1.5 * np.pi:
            for k in range(3):
                turn[f, k] *= (angle + 2 * np.pi * turns) / angle
    apart = 0.0
    for k in range(3):
        apart += (turn[f, k] - guide[g, k]) ** 2
    return np.sqrt(apart)


@njit(cache=True, nogil=True)
def follow(turn: np.ndarray, near: np.ndarray) -> None:
    """Move every rotation vector to the branch of the same face a frame away."""
    for f in range(len(turn)):
        nearest_branch(turn, f, near, f)


@njit(cache=True, nogil=True)
def unwrap(turn: np.ndarray, neighbours: np.ndarray) -> None:
    """Move every rotation vector to the branch of its neighbours, the most alike first.

    Faces are met from the one that turns least; those unlike the face they are met from wait until nobody alike
    is left, so that a few crumpled faces do not turn whole limbs the wrong way.
    """
    count = len(turn)
    seen = np.zeros(count, np.bool_)
    alike, unlike = np.empty(count, np.int32), np.empty((3 * count, 2), np.int32)
    square = np.empty(count)
    for f in range(count):
        square[f] = turn[f, 0] ** 2 + turn[f, 1] ** 2 + turn[f, 2] ** 2
    # below a quarter turn no branch is nearer than the one they are on
    if square.max() < (0.5 * np.pi) ** 2:
        return
    head, tail, waiting, last, found = 0, 0, 0, 0, 0
    while found < count:
        if waiting < last:
            start, guide = unlike[waiting, 0], unlike[waiting, 1]
            waiting += 1
            if seen[start]:
                continue
            nearest_branch(turn, start, turn, guide)
        else:
            start = np.argmin(square)
        seen[start] = True
        square[start] = np.inf
        found += 1
        alike[tail] = start
        tail += 1
        while head < tail:
            f = alike[head]
            head += 1
            for side in range(3):
                g = neighbours[f, side]
                if g < 0 or seen[g]:
                    continue
                if nearest_branch(turn, g, turn, f) < _ALIKE:
                    seen[g] = True
                    square[g] = np.inf
                    found += 1
                    alike[tail] = g
                    tail += 1
                else:
                    unlike[last, 0], unlike[last, 1] = g, f
                    last += 1
