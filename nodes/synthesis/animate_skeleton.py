"""The skeletal motion of a path."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels import rotation
from reperform.nodes.kernels.articulation import joint_positions, local_turns, world_turns
from reperform.nodes.kernels.ground_plane import rotate_ground
from reperform.nodes.product import Dataset
from reperform.nodes.products.mocap import Mocap, SkeletalAnimation
from reperform.nodes.products.motion import MotionPath
from reperform.nodes.products.performance import SkeletonSequence

_WHO = "synthesis.animate_skeleton"
# Skeletons whose bones differ by more are not one, m.
_SAME = 1e-3


@node(over="dataset")
def animate_skeleton(path: MotionPath, mocap: Dataset[Mocap]) -> SkeletalAnimation:
    """Play a path: captured poses placed on the ground, and blends of two of them during transitions.

        root = sum_i w_i (R_y(yaw_i) root_i + offset_i);  every rotation against its parent by slerp

    So bones keep their lengths. Weights are flat at both ends of a transition: velocity is continuous. The
    provenance comes along.

    Raises ValueError where a take of the path is missing or takes have different skeletons.
    Source: Kovar, Gleicher and Pighin 2002, SIGGRAPH, section 3.2 (003 section 3.2.1).
    """
    origin = path.provenance
    takes = [str(take) for take in np.asarray(origin.takes)]
    numbers = np.unique(np.asarray(origin.take)).tolist()
    for k in numbers:
        if takes[k] not in mocap:
            raise ValueError(
                f"{_WHO}: the path plays {takes[k]!r}; the motion capture has {', '.join(mocap)}"
            )
    first = mocap[takes[numbers[0]]]
    parents, offset = np.asarray(first.skeleton.parents), np.asarray(first.offset)
    for k in numbers:
        other = mocap[takes[k]]
        same = np.array_equal(np.asarray(other.skeleton.names), np.asarray(first.skeleton.names))
        if not same or np.abs(np.asarray(other.offset) - offset).max() > _SAME:
            raise ValueError(
                f"{_WHO}: takes must be of one skeleton; {takes[k]} differs from {takes[numbers[0]]}: retarget it first"
            )
    root, local = [], []
    for side in range(2):
        places = [_placed(mocap, takes, path, f, side) for f in range(len(np.asarray(origin.take)))]
        root.append(np.stack([place[0] for place in places]))
        local.append(local_turns(parents, np.stack([place[1] for place in places])))
    weight = np.asarray(origin.weight, np.float64)
    blended = rotation.slerp(local[0], local[1], weight[:, 1:])
    where = weight[:, :1] * root[0] + weight[:, 1:] * root[1]
    return skeletal_animation(first.skeleton, offset, where, world_turns(parents, blended), path)


def skeletal_animation(
    skeleton: SkeletonSequence,
    offset: np.ndarray,
    root: np.ndarray,
    turn: np.ndarray,
    path: MotionPath | SkeletalAnimation,
) -> SkeletalAnimation:
    """The product of roots (F, 3) and rotations in the world (F, J, 3, 3) of a skeleton."""
    joints = joint_positions(np.asarray(skeleton.parents), np.asarray(offset, np.float64), root, turn)
    moved = skeleton._replace(joints=joints.astype(np.float32))
    return SkeletalAnimation(
        Mocap(moved, turn.astype(np.float32), np.asarray(offset, np.float32)), path.provenance
    )


def _placed(
    mocap: Dataset[Mocap], takes: list[str], path: MotionPath, f: int, side: int
) -> tuple[np.ndarray, np.ndarray]:
    """Root (3,) and rotations (J, 3, 3) of source `side` of frame f, where it is shown."""
    origin = path.provenance
    take = mocap[takes[int(origin.take[f, side])]]
    frame, yaw = int(origin.source_frame[f, side]), float(origin.yaw[f, side])
    root = np.asarray(take.skeleton.joints[frame, 0], np.float64)
    ground = rotate_ground(root[[0, 2]], yaw) + np.asarray(origin.offset[f, side])
    turned = rotation.exp(np.array([0.0, yaw, 0.0])) @ np.asarray(take.rotation[frame], np.float64)
    return np.array([ground[0], root[1], ground[1]]), turned
