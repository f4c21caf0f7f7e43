import numpy as np
import pytest

from reperform.nodes.synthesis.timed_poses import timed_poses

POSES = ("ahead:3", "left:20", "right:10", "ahead:20")


def test_poses_are_shown_at_their_times(pose_graph, likeness, strides):
    asked = tuple(f"{pose}@{time}" for pose, time in zip(POSES, (1.0, 2.2, 3.4, 5.0), strict=True))
    walk = timed_poses(pose_graph, likeness, strides, poses=asked)
    np.testing.assert_allclose(walk.asked, [0, 30, 60, 100])
    assert np.abs(walk.shown - walk.asked).max() <= 2
    names = list(strides)
    for shown, pose in zip(walk.shown, POSES, strict=True):
        take, frame = pose.split(":")
        side = int(walk.weight[shown].argmax())
        assert walk.weight[shown, side] == 1.0
        assert (names[walk.take[shown, side]], walk.time[shown, side]) == (take, int(frame))
    assert walk.bound == walk.cost


def test_a_captured_stretch_comes_back_as_captured(pose_graph, likeness, strides):
    walk = timed_poses(pose_graph, likeness, strides, poses=("left:4@0", "left:24@0.8"))
    np.testing.assert_allclose(walk.time[:, 0], np.arange(4, 25))
    np.testing.assert_allclose(walk.cost, 20 * 0.02)


def test_what_cannot_be_in_time_is_named_with_when_it_could_be(pose_graph, likeness, strides):
    with pytest.raises(ValueError, match=r"no walk shows 'left:24@0\.1' .* could be shown at 0\.\d+ s"):
        timed_poses(pose_graph, likeness, strides, poses=("left:4@0", "left:24@0.1"))


@pytest.mark.parametrize(
    ("poses", "message"),
    [
        (("left:4@0",), "at least two poses"),
        (("left:4@0", "left:9@0"), "times must increase"),
        (("left:4", "left:9@1"), "must read TAKE:FRAME@SECONDS"),
    ],
)
def test_wrong_requests_are_refused(pose_graph, likeness, strides, poses, message):
    with pytest.raises(ValueError, match=message):
        timed_poses(pose_graph, likeness, strides, poses=poses)
