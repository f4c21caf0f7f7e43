"""Legs of a skeleton that put the ankle where it is wanted: two bones in closed form."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.ndimage import maximum_filter1d, uniform_filter1d

# Bones shorter than this share of the skeleton's height belong to the foot.
_SHORT = 0.12
# A leg is never drawn quite straight, or the knee would snap.
_LONGEST = 0.998


class Leg(NamedTuple):
    """Joints of one leg, and all joints that move with its foot."""

    hip: int
    knee: int
    ankle: int
    foot: np.ndarray


def leg_of(sole: int, parents: np.ndarray, offset: np.ndarray, height: float) -> Leg:
    """The leg that a joint of the sole belongs to: the first two long bones above it.

    Raises ValueError where there are no two such bones.
    """
    ankle = sole
    while ankle > 0 and np.linalg.norm(offset[ankle]) < _SHORT * height:
        ankle = int(parents[ankle])
    knee = int(parents[ankle]) if ankle > 0 else -1
    hip = int(parents[knee]) if knee > 0 else -1
    if hip < 0 or np.linalg.norm(offset[knee]) < _SHORT * height:
        raise ValueError(
            f"leg: two bones of at least {_SHORT * height:.2f} m needed above joint {sole}, found none"
        )
    below = np.zeros(len(parents), bool)
    below[ankle] = True
    for joint in range(ankle + 1, len(parents)):
        below[joint] = below[parents[joint]]
    return Leg(hip, knee, ankle, np.flatnonzero(below))


def needed_drop(joints: np.ndarray, leg: Leg, wanted: np.ndarray, fps: float) -> np.ndarray:
    """How far the hips must come down, (T,), m, for the leg to reach `wanted` (T, 3), smooth over 0.1 s."""
    reach = _LONGEST * _length(joints, leg.hip, leg.knee) + _LONGEST * _length(joints, leg.knee, leg.ankle)
    line = wanted - joints[:, leg.hip]
    flat = np.minimum((line[:, [0, 2]] ** 2).sum(axis=1), 0.9 * reach**2)
    over = np.maximum(-line[:, 1] - np.sqrt(reach**2 - flat), 0.0)
    window = 2 * max(1, round(0.1 * fps)) + 1
    return np.asarray(uniform_filter1d(maximum_filter1d(over, window), window))


def reach(joints: np.ndarray, turn: np.ndarray, leg: Leg, wanted: np.ndarray) -> None:
    """Turn hip and knee in place (turn (T, J, 3, 3)) so that the ankle comes to `wanted` (T, 3).

    The knee stays in its plane, the foot keeps its turn in the world, and bones their lengths; where `wanted` is
    too far the leg points at it.
    """
    upper, lower = _length(joints, leg.hip, leg.knee), _length(joints, leg.knee, leg.ankle)
    thigh = joints[:, leg.knee] - joints[:, leg.hip]
    shin = joints[:, leg.ankle] - joints[:, leg.knee]
    # where the leg is straight its plane is that of the usual bend, as the thigh carries it
    bend = np.cross(thigh, shin) / (upper * lower)
    local = np.einsum("tji,tj->ti", turn[:, leg.hip], bend).mean(axis=0)
    usual = turn[:, leg.hip] @ (local / max(float(np.linalg.norm(local)), 1e-12))
    line = wanted - joints[:, leg.hip]
    distance = np.linalg.norm(line, axis=1)
    far = np.clip(distance, abs(upper - lower) + 1e-3, _LONGEST * (upper + lower))
    line = line / distance[:, None]
    hinge = bend + 0.1 * usual
    new_hinge = _unit(hinge - (hinge * line).sum(axis=1, keepdims=True) * line)
    out = np.cross(line, new_hinge)
    along = (upper**2 - lower**2 + far**2) / (2 * far)
    aside = np.sqrt(np.maximum(upper**2 - along**2, 0.0))
    new_thigh = along[:, None] * line + aside[:, None] * out
    new_shin = far[:, None] * line - new_thigh
    for joint, old, new in ((leg.hip, thigh, new_thigh), (leg.knee, shin, new_shin)):
        turn[:, joint] = _frame(new, new_hinge) @ np.swapaxes(_frame(old, hinge), 1, 2) @ turn[:, joint]


def _length(joints: np.ndarray, one: int, other: int) -> float:
    return float(np.median(np.linalg.norm(joints[:, other] - joints[:, one], axis=1)))


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)


def _frame(axis: np.ndarray, hinge: np.ndarray) -> np.ndarray:
    axis = _unit(axis)
    hinge = _unit(hinge - (hinge * axis).sum(axis=1, keepdims=True) * axis)
    return np.stack([axis, hinge, np.cross(axis, hinge)], axis=-1)
