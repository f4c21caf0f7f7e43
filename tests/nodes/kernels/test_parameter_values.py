import numpy as np
import pytest

from reperform.nodes.kernels.parameter_values import values_at


@pytest.mark.parametrize("d", [1, 2, 3])
def test_an_affine_map_is_met_everywhere_and_kept_at_the_edge(d: int):
    rng = np.random.default_rng(d)
    corners = np.array(np.meshgrid(*[[0.0, 1.0]] * d)).reshape(d, -1).T
    samples = np.concatenate([corners, rng.random((40, d))])
    matrix, shift = rng.normal(size=(d, d)), rng.normal(size=d)
    inside = rng.random((30, d))
    np.testing.assert_allclose(
        values_at(inside, samples, samples @ matrix + shift), inside @ matrix + shift, atol=1e-9
    )
    far = values_at(np.full((1, d), 2.0), samples, samples @ matrix + shift)
    np.testing.assert_allclose(far[0], np.ones(d) @ matrix + shift, atol=1e-9)


def test_nothing_asked_is_nothing():
    assert values_at(np.zeros((0, 2)), np.eye(2), np.eye(2)).shape == (0, 2)
