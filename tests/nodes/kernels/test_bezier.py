import numpy as np
import pytest
from scipy.integrate import quad

from reperform.nodes.kernels.bezier import (
    bezier_points,
    bezier_velocity,
    curve_of,
    polyline_distance,
    through,
)

CONTROLS = np.array([[0.3, -1], [1.5, 0.2], [-2, 1.4], [0.4, 3], [2.8, 4.6], [3, 2], [5.2, 2.5]])


def test_a_straight_cubic_is_sampled_evenly_however_its_controls_bunch():
    curve = curve_of(np.array([[1, 2], [1.1, 2.2], [1.2, 2.4], [4, 8]]), 0.1)
    assert curve.length == pytest.approx(np.hypot(3, 6), rel=1e-8)
    np.testing.assert_allclose(
        np.diff(curve.point, axis=0),
        np.diff(curve.point, axis=0)[:1].repeat(len(curve.arc) - 1, 0),
        atol=1e-6,
    )
    np.testing.assert_allclose(curve.tangent, np.tile([1, 2] / np.sqrt(5), (len(curve.arc), 1)), atol=1e-9)


def test_arc_length_is_that_of_quadrature_and_steps_are_equal():
    curve = curve_of(CONTROLS, 0.01)
    whole = sum(
        quad(lambda t: np.linalg.norm(bezier_velocity(CONTROLS, np.array([t]))), k, k + 1, epsabs=1e-11)[0]
        for k in (0, 1)
    )
    assert curve.length == pytest.approx(whole, abs=1e-6)
    steps = np.linalg.norm(np.diff(curve.point, axis=0), axis=1)
    assert steps.max() / np.median(steps) < 1.001


def test_velocity_is_the_derivative():
    t = np.array([0.2, 0.9, 1.4])
    step = (bezier_points(CONTROLS, t + 1e-6) - bezier_points(CONTROLS, t - 1e-6)) / 2e-6
    np.testing.assert_allclose(bezier_velocity(CONTROLS, t), step, rtol=1e-6)


def test_a_smooth_chain_passes_through_its_points_without_a_kink():
    points = np.array([[0, 0], [1, 0.5], [1.2, 3], [-2, 4]])
    controls = through(points)
    np.testing.assert_allclose(bezier_points(controls, np.arange(4)), points, atol=1e-12)
    for k in (1, 2):
        before, after = bezier_velocity(controls, np.array([k - 1e-9, k + 1e-9]))
        assert np.dot(before, after) == pytest.approx(
            np.linalg.norm(before) * np.linalg.norm(after), rel=1e-6
        )


def test_distance_to_a_curve():
    curve = curve_of(np.array([[0, 0], [1, 0], [2, 0], [3, 0]]), 0.1)
    np.testing.assert_allclose(
        polyline_distance(curve.point, np.array([[1.03, 0.2], [4, 0]])), [0.2, 1.0], atol=1e-9
    )


@pytest.mark.parametrize("controls", [np.zeros((4, 2)), np.zeros((5, 2)), np.full((4, 2), np.nan)])
def test_what_is_no_curve_is_refused(controls):
    with pytest.raises(ValueError, match="curve"):
        curve_of(controls)
