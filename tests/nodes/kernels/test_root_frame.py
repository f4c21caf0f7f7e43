"""Travel and turn of bodies moved by known amounts."""

import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.kernels.root_frame import mean_shape, root_steps, to_root, travel

REST = np.random.default_rng(1).normal(size=(40, 3)) * [0.3, 0.5, 0.15] + [0.1, 1.0, 0.0]


def moved(yaw: np.ndarray, track: np.ndarray) -> np.ndarray:
    return np.stack([apply(REST, Placement(float(a), xz)) for a, xz in zip(yaw, track, strict=True)])


def test_poses_are_told_from_travel():
    yaw, track = np.linspace(0.3, 7.5, 50), np.random.default_rng(2).normal(size=(50, 2))
    local, ground, turned = to_root(moved(yaw, track), REST)
    assert np.ptp(local, axis=0).max() < 1e-12
    # unwrapped past half a turn
    assert turned - turned[0] == pytest.approx(yaw - yaw[0])
    assert local[..., [0, 2]].mean(axis=1) == pytest.approx(0, abs=1e-12)
    centre = REST[:, [0, 2]].mean(axis=0)
    assert ground[7] == pytest.approx(
        apply(np.array([centre[0], 0, centre[1]]), Placement(yaw[7], track[7]))[[0, 2]]
    )


def test_steps_add_up_to_the_way_there():
    yaw, track = (
        np.cumsum(np.full(30, 0.11)),
        np.cumsum(np.random.default_rng(3).normal(size=(30, 2)), axis=0),
    )
    steps = root_steps(track, yaw)
    ground, turned = travel(steps)
    c, s = np.cos(yaw[0]), np.sin(yaw[0])
    placed = ground @ np.array([[c, -s], [s, c]]) + track[0]
    assert placed == pytest.approx(track)
    assert turned + yaw[0] == pytest.approx(yaw)


def test_a_body_that_travels_faces_ahead():
    time = np.arange(60) / 25
    heading = 1.2
    track = 1.5 * time[:, None] * [np.sin(heading), np.cos(heading)]
    # the body itself is turned away from where it goes
    take = moved(np.full(60, heading + 0.4), track)
    _, ground, yaw = to_root(take, mean_shape(take))
    steps = root_steps(ground, yaw)
    assert steps[:, 0] == pytest.approx(0, abs=1e-9)
    assert steps[:, 1] == pytest.approx(1.5 / 25)
    still = moved(np.full(5, 0.7), np.zeros((5, 2)))
    assert to_root(still, mean_shape(still))[2] == pytest.approx(0)
