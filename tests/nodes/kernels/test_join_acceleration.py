import numpy as np
import pytest

from reperform.nodes.kernels.join_acceleration import (
    frame_accelerations,
    join_acceleration_ratio,
    join_frames,
)


def _fall(frames: int, gravity: float, fps: float) -> np.ndarray:
    """Fifty points that fall and drift; one of them flies off three times as hard."""
    time = np.arange(frames)[:, None, None] / fps
    points = np.random.default_rng(1).normal(size=(1, 50, 3)) + time * [0.3, 0.0, -1.0]
    pull = np.zeros((1, 50, 3))
    pull[..., 1] = -gravity
    pull[:, 7, 1] = -3 * gravity
    return points + 0.5 * pull * time**2


def test_a_fall_accelerates_by_gravity() -> None:
    found = frame_accelerations(_fall(6, 9.81, 25.0), 25.0, 0.9)
    assert np.isnan(found[[0, -1]]).all()
    np.testing.assert_allclose(found[1:-1], 9.81)
    np.testing.assert_allclose(frame_accelerations(_fall(6, 9.81, 50.0), 50.0, 1.0)[1:-1], 3 * 9.81)


def test_joins_are_the_blended_frames_and_their_neighbours() -> None:
    weight = np.zeros((8, 2))
    weight[3:5, 1] = 0.5
    np.testing.assert_array_equal(np.flatnonzero(join_frames(weight)), [2, 3, 4, 5])


def test_the_ratio_compares_joins_with_the_capture() -> None:
    weight = np.zeros((8, 2))
    weight[3:5, 1] = 0.5
    ratio = join_acceleration_ratio(_fall(8, 4.0, 25.0), weight, [_fall(9, 2.0, 25.0)], 25.0)
    assert ratio == pytest.approx(2.0)
    assert np.isnan(join_acceleration_ratio(_fall(8, 4.0, 25.0), 0 * weight, [_fall(9, 2.0, 25.0)], 25.0))
