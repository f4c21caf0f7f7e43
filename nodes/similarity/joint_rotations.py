"""Dissimilarity of poses by the rotations of their joints."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.product import Pair
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.products.performance import BoneRotations


@node(over="pair")
def joint_rotations(bones: Pair[BoneRotations]) -> Dissimilarity:
    """How far the joints of every frame of one take are turned from those of the other, in radians: (frame_a, frame_b).

        d(i, j) = mean over joints k of angle(q_k(j)^-1 q_k(i)),   q_k = R_parent(k)^-1 R_k

    R: rotation of the bones that hang on a joint, in the world, (frames, joints, 3, 3). The root has no parent: of its
    rotation what is left once the turn about the vertical is taken out counts, so that heading does not.

    Raises ValueError where the skeletons differ.
    Source: Lee, Chai, Reitsma, Hodgins and Pollard 2002, SIGGRAPH, eq 4 (geodesic distances between joint
    orientations, the skeleton distance that 002 section 2.2 names). Departure: all joints weigh alike; the place of
    the root and velocities do not count.
    """
    a, b = bones
    if a.rotation.shape[1] != b.rotation.shape[1] or not np.array_equal(a.parents, b.parents):
        raise ValueError(
            f"similarity.joint_rotations: both skeletons must have the same joints and parents, got "
            f"{a.rotation.shape[1]} and {b.rotation.shape[1]} joints"
        )
    first, second = (_local(np.asarray(x.rotation, np.float64), np.asarray(x.parents)) for x in bones)
    total = np.zeros((len(first), len(second)))
    for k in range(first.shape[1]):
        # |A - B|^2 = 8 sin^2(angle / 2): accurate for small angles too
        square = np.square(first[:, None, k] - second[None, :, k]).sum(axis=(-1, -2))
        total += 2.0 * np.arcsin(np.minimum(np.sqrt(square / 8.0), 1.0))
    return Dissimilarity((total / first.shape[1]).astype(np.float32))


def _local(world: np.ndarray, parents: np.ndarray) -> np.ndarray:
    """Rotations (T, K, 3, 3) against the parent's; the root's without its turn about the vertical."""
    out = np.empty_like(world)
    for k, parent in enumerate(parents):
        out[:, k] = (
            np.swapaxes(world[:, parent], 1, 2) @ world[:, k] if parent >= 0 else _without_turn(world[:, k])
        )
    return out


def _without_turn(rotation: np.ndarray) -> np.ndarray:
    """R_y(yaw)^-1 R with the yaw by which R_y(yaw) comes nearest R: the twist about the vertical."""
    yaw = np.arctan2(rotation[:, 0, 2] - rotation[:, 2, 0], rotation[:, 0, 0] + rotation[:, 2, 2])
    back = np.zeros_like(rotation)
    back[:, 0, 0] = back[:, 2, 2] = np.cos(yaw)
    back[:, 0, 2], back[:, 2, 0] = -np.sin(yaw), np.sin(yaw)
    back[:, 1, 1] = 1.0
    return np.asarray(back @ rotation)
