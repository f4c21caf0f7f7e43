import numpy as np
import pytest

from reperform.nodes.kernels.curve_samples import curve_samples


def test_a_circle_is_met_at_even_steps():
    angle = np.linspace(0.2, 2.4, 60)
    points = 1.5 * np.column_stack([np.cos(angle), np.sin(angle)]) + (3, -1)
    samples, length = curve_samples(points, 0.05, 0.5)
    inside = samples[: int(length / 0.05)]
    assert abs(length - 1.5 * 2.2) < 2e-3
    np.testing.assert_allclose(np.linalg.norm(inside - (3, -1), axis=1), 1.5, atol=2e-3)
    np.testing.assert_allclose(np.linalg.norm(np.diff(inside, axis=0), axis=1), 0.05, atol=1e-4)


def test_it_goes_on_straight_beyond_its_end():
    samples, length = curve_samples(np.array([(0, 0), (3, 4)]), 0.5, 2.0)
    assert abs(length - 5.0) < 1e-9
    np.testing.assert_allclose(samples[-1], (7 * 0.6, 7 * 0.8), atol=1e-9)


def test_a_point_twice_is_refused():
    with pytest.raises(ValueError, match="apart from the one before"):
        curve_samples(np.array([(0, 0), (0, 0), (1, 1)]), 0.1, 1.0)
