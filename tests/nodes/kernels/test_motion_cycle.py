import numpy as np
import pytest

from reperform.nodes.kernels.motion_cycle import close_loop, find_cycle
from reperform.nodes.kernels.resample_time import at_times


def wave(period: float, frames: int) -> np.ndarray:
    phase = 2 * np.pi * np.arange(frames) / period
    return np.stack([np.sin(phase), np.cos(2 * phase), 0.4 * np.cos(phase + 1)], axis=1)


@pytest.mark.parametrize("period", [17.0, 23.4, 27.78])
def test_the_length_of_a_cycle_is_found_between_frames(period):
    points = wave(period, 60)
    distance = np.linalg.norm(points[:, None] - points[None], axis=2)
    start, length = find_cycle(distance, 25.0, np.array([3.5, 40.0]))
    assert start == 3.5
    assert length == pytest.approx(period, abs=0.05)


def test_a_motion_that_does_not_repeat_itself_has_none():
    line = np.arange(40.0)
    assert find_cycle(np.abs(line[:, None] - line[None]), 25.0, np.zeros(0)) is None
    assert find_cycle(np.zeros((5, 5)), 25.0, np.zeros(0)) is None


def test_a_closed_loop_has_no_gap_and_keeps_its_mean_shape():
    open_ended = wave(20.0, 21) + 0.01 * np.arange(21)[:, None]
    closed = close_loop(open_ended)
    # drift is all that went wrong, and all that is taken off
    assert np.diff(closed - wave(20.0, 20), axis=0) == pytest.approx(0, abs=1e-12)
    assert np.abs(closed - open_ended[:-1]).max() == pytest.approx(0.1)


def test_between_frames_cubics_are_met_exactly():
    t = np.arange(12.0)
    values = np.stack([2 - t, 0.3 * t**2 - t], axis=1)
    at = np.array([0.0, 3.0, 4.25, 8.5, 11.0])
    assert at_times(values, at)[1:4] == pytest.approx(np.stack([2 - at, 0.3 * at**2 - at], axis=1)[1:4])
    assert at_times(values, at)[[0, 1, 4]].tolist() == values[[0, 3, 11]].tolist()
    assert at_times(t, np.array([-0.5, 11.5])) == pytest.approx([-0.5, 11.5])
