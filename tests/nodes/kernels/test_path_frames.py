import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.kernels.path_frames import (
    Passage,
    arc_length,
    ease,
    ground_track,
    passage_track,
    path_frames,
)


def test_by_hand() -> None:
    passage = Passage(0, 1, 5, 9, 2, Placement(np.pi / 2, np.array([1.0, 0.0])))
    frames = path_frames(0, 1, [passage], 12)
    np.testing.assert_array_equal(frames.frame[:, 0], [1, 2, 3, 4, 5, 6, 11, 12])
    np.testing.assert_array_equal(frames.frame[3:6, 1], [8, 9, 10])
    np.testing.assert_array_equal(frames.take[:, 0], [0, 0, 0, 0, 0, 0, 1, 1])
    np.testing.assert_allclose(frames.weight[3:6, 1], [0.15625, 0.5, 0.84375])
    np.testing.assert_allclose(frames.weight.sum(axis=1), 1.0)
    np.testing.assert_allclose(frames.yaw[-1], np.pi / 2)


def test_weights_are_flat_at_both_ends() -> None:
    weights = ease(20)
    assert weights[0] == 0.0
    assert weights[-1] == 1.0
    assert abs(np.diff(weights)[[0, -1]]).max() < 0.1 * np.diff(weights).max()


def test_placements_accumulate() -> None:
    # one take, walked along x; each loop turns by 90 degrees where it leaves, at frame 8, and enters at frame 2
    track = np.stack([np.arange(11.0), np.zeros(11)], axis=1)
    place = Placement(np.pi / 2, np.array([8.0, 2.0]))
    loop = Passage(0, 0, 8, 2, 1, place)
    np.testing.assert_allclose(apply(np.array([[2.0, 0, 0]]), place), [[8.0, 0, 0]], atol=1e-12)
    frames = path_frames(0, 2, [loop] * 4, 2 + 1)
    walked = ground_track(frames, [track])
    # a square of side 6: back at the start after four loops (the last frame is one step on)
    np.testing.assert_allclose(walked[-1], walked[1], atol=1e-9)
    assert arc_length(passage_track(loop, [track])) == pytest.approx(arc_length(walked[5:8]))


def test_a_path_that_cannot_be_played_is_refused() -> None:
    loop = Passage(0, 0, 8, 2, 1, Placement(0.0, np.zeros(2)))
    with pytest.raises(ValueError, match="leaves take 0"):
        path_frames(0, 9, [loop], 10)
    with pytest.raises(ValueError, match="before frame"):
        path_frames(0, 0, [loop], 1)
