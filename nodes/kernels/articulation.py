"""Skeletons of rigid bones: positions from rotations, rotations against the parent, frames in between."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels import rotation


class Articulation(NamedTuple):
    """A moving skeleton of J joints, parents before children, joint 0 the root.

    names (J,), parents (J,) with -1 for the root, offset (J, 3) from the parent at rest; over T frames root
    (T, 3) and turn (T, J, 3, 3), the rotation in the world of all that hangs on a joint.
    """

    names: list[str]
    parents: np.ndarray
    offset: np.ndarray
    root: np.ndarray
    turn: np.ndarray


def joint_positions(
    parents: np.ndarray, offset: np.ndarray, root: np.ndarray, turn: np.ndarray
) -> np.ndarray:
    """(T, J, 3): joint = parent's joint + parent's turn times its offset."""
    joints = np.empty((len(root), len(parents), 3))
    joints[:, 0] = root
    for j in range(1, len(parents)):
        joints[:, j] = joints[:, parents[j]] + turn[:, parents[j]] @ offset[j]
    return joints


def local_turns(parents: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Rotations (T, J, 3, 3) of each joint against its parent; the root against the world."""
    local = turn.copy()
    local[:, 1:] = np.swapaxes(turn[:, parents[1:]], -1, -2) @ turn[:, 1:]
    return local


def world_turns(parents: np.ndarray, local: np.ndarray) -> np.ndarray:
    """Rotations in the world of local ones (T, J, 3, 3)."""
    turn = local.copy()
    for j in range(1, len(parents)):
        turn[:, j] = turn[:, parents[j]] @ local[:, j]
    return turn


def resampled(motion: Articulation, fps: float, wanted: float) -> Articulation:
    """The motion at another frame rate: roots linear, rotations against the parent by slerp between frames."""
    count = int(np.floor((len(motion.root) - 1) * wanted / fps + 1e-9)) + 1
    place = np.arange(count) * fps / wanted
    before = np.minimum(place.astype(int), max(len(motion.root) - 2, 0))
    after = np.minimum(before + 1, len(motion.root) - 1)
    weight = np.clip(place - before, 0.0, 1.0)
    local = local_turns(motion.parents, motion.turn)
    between = rotation.slerp(local[before], local[after], weight[:, None])
    w = weight[:, None]
    root = (1 - w) * motion.root[before] + w * motion.root[after]
    return motion._replace(root=root, turn=world_turns(motion.parents, between))


def euler(angles: np.ndarray, axes: str) -> np.ndarray:
    """Rotations (..., 3, 3) of angles (..., n), radians, about the axes named in `axes`, multiplied as listed."""
    unit = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}
    out = np.broadcast_to(np.eye(3), (*angles.shape[:-1], 3, 3)).copy()
    for k, axis in enumerate(axes):
        out = out @ rotation.exp(angles[..., k, None] * np.array(unit[axis]))
    return out
