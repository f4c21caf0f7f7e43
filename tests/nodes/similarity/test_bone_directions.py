import numpy as np
import pytest

from reperform.nodes.kernels import rotation
from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.products.performance import SkeletonSequence
from reperform.nodes.similarity.bone_directions import bone_directions

PARENTS = np.array([-1, 0, 1, 0, 3], np.int32)


def skeleton(joints: np.ndarray) -> SkeletonSequence:
    names = np.array(list("abcde"))
    return SkeletonSequence(joints.astype(np.float32), PARENTS, names, np.float32(25))


def poses(seed: int, frames: int) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(frames, 5, 3)) * (0.3, 0.8, 0.2)


def test_directions_by_hand():
    # one of two bones of lengths 1 and 3 turns by 0.7 in a vertical plane; the points in line keep the turn at 0
    joints = np.zeros((1, 5, 3))
    joints[0, 1:3] = [[0, 1, 0], [0, 1, 1e-9]]
    joints[0, 3:] = [[0, 0, 3], [0, 0, 3 + 1e-9]]
    moved = joints.copy()
    moved[0, 1:3] = [[0, np.cos(0.7), np.sin(0.7)]] * 2
    distance = bone_directions((skeleton(joints), skeleton(moved))).distance[0, 0]
    assert distance == pytest.approx(0.7 * 1 / 4, abs=1e-6)


def test_placing_a_skeleton_elsewhere_changes_nothing_and_tilting_it_does():
    a = poses(2, 4)
    moved = apply(a, Placement(-2.1, np.array([4.0, 1.0])))
    found = bone_directions((skeleton(a), skeleton(moved))).distance
    np.testing.assert_allclose(found.diagonal(), 0, atol=1e-6)
    tilted = a @ rotation.exp(np.array([0.4, 0, 0])).T
    assert bone_directions((skeleton(a), skeleton(tilted))).distance.diagonal().min() > 0.1


def test_other_joints_are_refused():
    a = skeleton(poses(3, 2))
    with pytest.raises(ValueError, match="same joints and parents"):
        bone_directions((a, a._replace(joints=a.joints[:, :4], parents=PARENTS[:4])))
