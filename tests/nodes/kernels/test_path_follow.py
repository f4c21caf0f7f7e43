import numpy as np
import pytest

from reperform.nodes.kernels.bezier import curve_of, polyline_distance, through
from reperform.nodes.kernels.path_follow import Follower

LIMITS = np.array([0.6, 1.6, 1.3, 1.5])


def walk(curve, x, z, heading, dt=0.02, seconds=30):
    """A point that does at once what it is told."""
    follower, speed, track = Follower(curve, LIMITS), LIMITS[0], []
    for _ in range(round(seconds / dt)):
        speed, turn, left = follower.command(x, z, heading, speed)
        if left <= 0.05:
            break
        heading += turn * dt
        x, z = x + speed * dt * np.sin(heading), z + speed * dt * np.cos(heading)
        track.append((x, z, speed, turn))
    return np.array(track), left


def test_three_turns_are_followed_closely_to_the_end():
    curve = curve_of(through(np.array([[0, 0], [1, 3], [-1.5, 5], [1, 8], [0, 11.0]])))
    track, left = walk(curve, 0.0, 0.0, float(np.arctan2(*curve.tangent[0])))
    assert left <= 0.05
    assert polyline_distance(curve.point, track[:, :2]).max() < 0.05
    assert np.abs(track[:, 3]).max() <= LIMITS[2]
    assert LIMITS[0] <= track[:, 2].min() and track[:, 2].max() <= LIMITS[1]


def test_on_a_straight_line_there_is_no_turning_and_full_speed():
    curve = curve_of(through(np.array([[1.0, 1.0], [4.0, 5.0]])))
    heading = float(np.arctan2(3, 4))
    assert Follower(curve, LIMITS).command(1.6, 1.8, heading, 1.2)[:2] == pytest.approx((1.6, 0.0), abs=1e-6)


def test_a_point_to_its_left_makes_it_turn_left():
    curve = curve_of(through(np.array([[0.0, 0.0], [0.0, 8.0]])))
    _, turn, _ = Follower(curve, LIMITS).command(-0.5, 1.0, 0.0, 1.2)
    assert turn > 0.2
    track, _ = walk(curve, -0.5, 0.0, -0.4)
    assert polyline_distance(curve.point, track[-100:, :2]).max() < 0.02
