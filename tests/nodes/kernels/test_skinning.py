import numpy as np
from scipy.spatial.transform import Rotation

from reperform.nodes.kernels.skinning import dual_quaternions, skin_dual_quaternion, skin_linear


def motions(frames: int, bones: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(seed)
    rotation = Rotation.from_rotvec(random.normal(0, 1, (frames * bones, 3))).as_matrix()
    return rotation.reshape(frames, bones, 3, 3), random.normal(0, 1, (frames, bones, 3))


def test_one_bone_moves_rigidly_in_both_ways():
    rotation, translation = motions(4, 1)
    vertices = np.random.default_rng(1).normal(0, 1, (20, 3))
    expected = np.einsum("tij,vj->tvi", rotation[:, 0], vertices) + translation
    weights = np.ones((20, 1))
    np.testing.assert_allclose(
        skin_dual_quaternion(vertices, weights, rotation, translation), expected, atol=2e-6
    )
    np.testing.assert_allclose(skin_linear(vertices, weights, rotation, translation), expected, atol=2e-6)


def test_dual_quaternions_are_unit():
    q = dual_quaternions(*motions(5, 3))
    np.testing.assert_allclose((q[..., :4] ** 2).sum(-1), 1, atol=1e-12)
    np.testing.assert_allclose((q[..., :4] * q[..., 4:]).sum(-1), 0, atol=1e-12)


def test_a_half_twist_keeps_the_radius_that_linear_blending_loses():
    rotation = np.stack([np.eye(3), Rotation.from_euler("y", 150, degrees=True).as_matrix()])[None]
    vertices = np.array([[0.1, 0.5, 0.0], [0.0, 0.5, 0.1]])
    weights = np.full((2, 2), 0.5)
    still = np.zeros((1, 2, 3))
    kept = skin_dual_quaternion(vertices, weights, rotation, still)[0]
    lost = skin_linear(vertices, weights, rotation, still)[0]
    np.testing.assert_allclose(np.hypot(kept[:, 0], kept[:, 2]), 0.1, atol=1e-6)
    np.testing.assert_allclose(np.hypot(lost[:, 0], lost[:, 2]), 0.1 * np.cos(np.radians(75)), atol=1e-6)
    turned = Rotation.from_euler("y", 75, degrees=True).apply(vertices)
    np.testing.assert_allclose(kept, turned, atol=1e-6)


def test_opposite_signs_of_the_same_rotation_do_not_cancel():
    almost = np.radians(179)
    rotation = Rotation.from_rotvec([[0, almost, 0], [0, -almost, 0]]).as_matrix()[None]
    posed = skin_dual_quaternion(
        np.array([[0.2, 0, 0]]), np.array([[0.5, 0.5]]), rotation, np.zeros((1, 2, 3))
    )
    np.testing.assert_allclose(posed[0, 0], [-0.2, 0, 0], atol=1e-6)
