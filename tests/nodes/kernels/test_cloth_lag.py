import numpy as np
import pytest

from reperform.nodes.kernels.cloth_lag import lag, push_out

STEP = 1 / 200


def test_a_still_body_leaves_the_cloth_still():
    targets = np.repeat(np.random.default_rng(0).normal(0, 1, (1, 5, 3)), 50, axis=0)
    assert not lag(targets, np.ones(5), STEP, 1.7, 0.3, 0.2).any()


def test_steady_motion_ends_in_a_lag_by_the_drag_alone():
    time = np.arange(4000) * STEP
    targets = np.zeros((len(time), 1, 3))
    targets[:, 0, 2] = 0.8 * time
    assert np.abs(lag(targets, np.ones(1), STEP, 2.0, 0.3, 0.0)[-1]).max() < 1e-9
    trailing = lag(targets, np.ones(1), STEP, 2.0, 0.3, 0.1)[-1, 0]
    # e = -2 z w d v / w^2, then the smooth bound
    free = 2 * 0.3 * 0.1 * 0.8 / (2 * np.pi * 2.0)
    assert trailing[2] == pytest.approx(-free / (1 + free / 0.16), rel=1e-3)
    assert trailing[0] == trailing[1] == 0


def test_a_stop_swings_at_the_damped_frequency():
    time = np.arange(800) * STEP
    targets = np.zeros((len(time), 1, 3))
    targets[:, 0, 0] = 0.4 * np.minimum(time, 1.0)
    swing = lag(targets, np.ones(1), STEP, 2.0, 0.1, 0.0)[200:, 0, 0]
    crossings = np.flatnonzero(np.diff(np.sign(swing[2:])))
    period = 2 * np.diff(crossings).mean() * STEP
    assert period == pytest.approx(1 / (2.0 * np.sqrt(1 - 0.1**2)), rel=0.03)


def test_looseness_scales_and_nothing_flies_off():
    time = np.arange(200) * STEP
    targets = np.zeros((len(time), 3, 3))
    targets[:, :, 1] = np.sin(40 * time)[:, None]
    moved = lag(targets, np.array([0.0, 0.5, 1.0]), STEP, 1.7, 0.3, 0.2)
    assert not moved[:, 0].any()
    assert np.abs(moved).max() < 0.16
    assert np.abs(moved[:, 2]).max() > np.abs(moved[:, 1]).max() > 0


def test_points_leave_a_capsule_outwards():
    starts, ends = np.array([[[0.1, 1.0, 0.0]]]), np.array([[[0.1, 0.4, 0.1]]])
    points = np.array([[[0.15, 0.7, 0.06], [0.4, 0.7, 0.0], [0.12, 0.2, 0.1]]])
    moved = push_out(points, np.zeros((1, 3)), starts, ends, np.array([[0.1, 0.1]]))
    assert np.hypot(*moved[0, 0, [0, 2]]) > np.hypot(*points[0, 0, [0, 2]])
    np.testing.assert_array_equal(moved[0, 1:], points[0, 1:])
    assert moved[0, 0, 1] == points[0, 0, 1]
