import cv2
import numpy as np
import pytest

from reperform.nodes.kernels.camera import centre, look_at, project, radial_limit

MATRIX = np.array([[812.0, 0, 333.5], [0, 790.0, 201.25], [0, 0, 1]])


def pose(seed: int = 3) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(seed)
    return cv2.Rodrigues(random.normal(size=3))[0], np.array([0.2, -0.3, 4.0])


@pytest.mark.parametrize("distortion", [None, np.array([-0.36, 0.14, 0.001, -0.002, -0.02])])
def test_agrees_with_opencv(distortion):
    rotation, translation = pose()
    points = np.random.default_rng(0).uniform(-1, 1, (200, 3))
    pixels, depth = project(points, MATRIX, rotation, translation, distortion)
    expected, _ = cv2.projectPoints(points, cv2.Rodrigues(rotation)[0], translation, MATRIX, distortion)
    np.testing.assert_allclose(pixels, expected.reshape(-1, 2), atol=1e-8)
    np.testing.assert_allclose(depth, (points @ rotation.T + translation)[:, 2])


def test_points_behind_and_folded_back_are_nan():
    rotation, translation = np.eye(3), np.zeros(3)
    distortion = np.array([-0.3, 0, 0, 0, 0.0])
    limit = radial_limit(distortion)
    assert limit == pytest.approx(1 / np.sqrt(0.9))
    points = np.array([[0, 0, -1.0], [0, 0, 0], [0.99 * limit, 0, 1], [1.01 * limit, 0, 1]])
    pixels, depth = project(points, MATRIX, rotation, translation, distortion)
    assert np.isnan(pixels).all(axis=1).tolist() == [True, True, False, True]
    np.testing.assert_array_equal(depth, points[:, 2])
    assert radial_limit(np.array([0.1, 0, 0, 0, 0])) == np.inf


def test_look_at_sees_the_target_in_the_middle_and_up_above():
    eye, target = np.array([3.0, 1.7, -2.0]), np.array([0.4, 1.1, 0.3])
    rotation, translation = look_at(eye, target)
    np.testing.assert_allclose(centre(rotation, translation), eye)
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1)
    pixels, depth = project(np.stack([target, target + [0, 0.2, 0]]), MATRIX, rotation, translation)
    np.testing.assert_allclose(pixels[0], MATRIX[:2, 2])
    assert pixels[1, 1] < pixels[0, 1]
    assert depth[0] == pytest.approx(np.linalg.norm(eye - target))


def test_look_at_refuses_a_direction_along_up():
    with pytest.raises(ValueError, match="move the eye sideways"):
        look_at(np.array([0, 5.0, 0]), np.zeros(3))


def test_centre_of_many_poses():
    poses = [pose(seed) for seed in range(4)]
    rotations, translations = (np.stack(part) for part in zip(*poses, strict=True))
    centres = centre(rotations, translations)
    np.testing.assert_allclose(np.einsum("kij,kj->ki", rotations, centres) + translations, 0, atol=1e-12)
