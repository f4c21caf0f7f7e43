import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from reperform.nodes.kernels import rotation


@pytest.mark.parametrize("size", [0.0, 1e-9, 1e-4, 1.0, np.pi - 1e-7, np.pi])
def test_exp_and_log_agree_with_scipy(size: float) -> None:
    axes = np.random.default_rng(2).normal(size=(200, 3))
    vectors = size * axes / np.linalg.norm(axes, axis=1, keepdims=True)
    matrices = rotation.exp(vectors)
    np.testing.assert_allclose(matrices, Rotation.from_rotvec(vectors).as_matrix(), atol=1e-12)
    np.testing.assert_allclose(rotation.exp(rotation.log(matrices)), matrices, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(rotation.log(matrices), axis=1), size, atol=1e-9)


def test_polar_gives_a_proper_rotation_and_a_symmetric_rest() -> None:
    matrices = np.random.default_rng(4).normal(size=(100, 3, 3))
    r, s = rotation.polar(matrices)
    np.testing.assert_allclose(r @ s, matrices, atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(r), 1.0)
    np.testing.assert_allclose(s, np.swapaxes(s, 1, 2), atol=1e-12)


def test_slerp_turns_evenly() -> None:
    a, b = rotation.exp(np.array([[0.1, 0.2, 0.3]])), rotation.exp(np.array([[1.0, -2.0, 0.5]]))
    whole = np.linalg.norm(rotation.log(np.swapaxes(a, 1, 2) @ b))
    third = rotation.slerp(a, b, np.array([1 / 3]))
    assert np.linalg.norm(rotation.log(np.swapaxes(a, 1, 2) @ third)) == pytest.approx(whole / 3)
    np.testing.assert_allclose(rotation.slerp(a, b, np.array([1.0])), b, atol=1e-12)
