import numpy as np
import pytest

from reperform.nodes.kernels.antialiased_view import coverage, pixel_mean, sample_view

MATRIX = np.array([[100.0, 0, 40.3], [0, 110.0, 22.7], [0, 0, 1]])
POSE = (MATRIX, np.eye(3), np.array([0.0, 0, 2.0]), np.zeros(5), np.array([90, 50]))
FACES = np.array([[0, 1, 2]], np.int32)


def triangle(x: float = 0.0) -> np.ndarray:
    return np.array([[-0.31 + x, -0.2, 0.0], [0.37 + x, -0.11, 0.0], [0.05 + x, 0.33, 0.0]], np.float32)


def test_the_coverage_of_a_triangle_is_its_area():
    vertices = triangle()
    area = 0.5 * np.linalg.norm(np.cross(vertices[1] - vertices[0], vertices[2] - vertices[0])) * 50 * 55
    alpha = coverage(sample_view(vertices, FACES, *POSE, 8), POSE[4])
    assert alpha.shape == (50, 90)
    assert alpha.sum() == pytest.approx(area, rel=2e-3)
    assert alpha.max() == 1
    assert ((alpha > 0) & (alpha < 1)).any()


def test_the_centre_of_coverage_is_the_projected_centroid():
    vertices = triangle()
    alpha = coverage(sample_view(vertices, FACES, *POSE, 8), POSE[4])
    ys, xs = np.indices(alpha.shape)
    centre = vertices.mean(axis=0)
    assert (alpha * xs).sum() / alpha.sum() == pytest.approx(50 * centre[0] + 40.3, abs=0.02)
    assert (alpha * ys).sum() / alpha.sum() == pytest.approx(55 * centre[1] + 22.7, abs=0.02)


def test_one_sample_is_the_pixel_centre():
    plain = coverage(sample_view(triangle(), FACES, *POSE, 1), POSE[4])
    assert set(np.unique(plain)) == {0.0, 1.0}


@pytest.mark.parametrize("x", [-0.9, 0.95, 5.0])
def test_what_leaves_the_picture_is_cut_off(x):
    alpha = coverage(sample_view(triangle(x), FACES, *POSE, 4), POSE[4])
    assert alpha.shape == (50, 90)
    assert (alpha.sum() > 0) == (abs(x) < 1.2)


def test_nothing_in_front_of_the_camera_is_nothing():
    behind = triangle() - np.array([0, 0, 5], np.float32)
    samples = sample_view(behind, FACES, *POSE, 3)
    assert samples.ids.size == 0
    assert not coverage(samples, POSE[4]).any()


def test_pixel_mean_averages_blocks():
    values = np.arange(24.0).reshape(4, 6)
    np.testing.assert_allclose(pixel_mean(values, 2), values.reshape(2, 2, 3, 2).mean(axis=(1, 3)))
