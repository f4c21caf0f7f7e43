import numpy as np
import pytest

from reperform.nodes.kernels.rotation import exp
from reperform.nodes.products.performance import BoneRotations
from reperform.nodes.similarity.joint_rotations import joint_rotations

PARENTS = np.array([-1, 0, 1, 0], np.int32)


def bones(rotation: np.ndarray) -> BoneRotations:
    return BoneRotations(rotation.astype(np.float32), PARENTS, np.float32(25))


def world(local: np.ndarray) -> np.ndarray:
    out = local.copy()
    for k, parent in enumerate(PARENTS):
        if parent >= 0:
            out[:, k] = out[:, parent] @ local[:, k]
    return out


def poses(seed: int, frames: int) -> np.ndarray:
    return exp(np.random.default_rng(seed).normal(size=(frames, 4, 3)) * 0.5)


def test_one_joint_turned_counts_by_its_angle_whatever_hangs_on_it():
    local = poses(1, 1)
    moved = local.copy()
    moved[0, 1] = moved[0, 1] @ exp(np.array([0.3, -0.5, 0.2]))
    distance = joint_rotations((bones(world(local)), bones(world(moved)))).distance[0, 0]
    assert distance == pytest.approx(np.linalg.norm([0.3, -0.5, 0.2]) / 4, abs=1e-6)


def test_heading_does_not_count_and_tilting_does():
    local = poses(2, 3)
    turned, tilted = local.copy(), local.copy()
    turned[:, 0] = exp(np.array([0, 2.2, 0])) @ turned[:, 0]
    tilted[:, 0] = exp(np.array([0.4, 0, 0])) @ tilted[:, 0]
    assert (
        np.abs(joint_rotations((bones(world(local)), bones(world(turned)))).distance.diagonal()).max() < 1e-3
    )
    assert joint_rotations((bones(world(local)), bones(world(tilted)))).distance.diagonal().min() > 0.01


def test_a_matrix_turned_over_is_that_of_the_takes_turned_over():
    a, b = bones(world(poses(3, 4))), bones(world(poses(4, 5)))
    np.testing.assert_allclose(
        joint_rotations((a, b)).distance, joint_rotations((b, a)).distance.T, atol=1e-6
    )


def test_other_joints_are_refused():
    a = bones(world(poses(5, 2)))
    with pytest.raises(ValueError, match="same joints and parents"):
        joint_rotations((a, a._replace(rotation=a.rotation[:, :3], parents=PARENTS[:3])))
