import numpy as np
import pytest

from reperform.nodes.evaluate.timed_poses import timed_poses
from reperform.nodes.products.pose_walk import PoseWalk


def walk(shown, asked, time):
    count = len(time)
    weight = np.tile([1.0, 0.0], (count, 1))
    weight[5] = 0.7, 0.3
    return PoseWalk(
        np.array(["a"]), np.zeros((count, 2), np.int32), np.column_stack([time, time]), weight, np.zeros((count, 2)),
        np.zeros((count, 2, 2)), np.zeros((count, 3)), np.full((count, 3), np.nan), np.array(shown, np.int32),
        np.array(asked, float), np.zeros(2, np.int32), np.array(1.0), np.array(1.0), np.array(1), np.float32(25),
    )  # fmt: skip


def test_frames_early_or_late_and_what_is_not_as_captured():
    time = np.arange(9.0)
    time[7] = 6.75
    out = timed_poses(walk([0, 4, 5, 7], [0, 2.5, 5, 8], time))
    np.testing.assert_allclose(out.value[:, 0], [0, 1.5, 0, 1])
    np.testing.assert_allclose(out.value[:, 1], [0, 0, 0.3, 0.25])


def test_a_walk_without_times_is_refused():
    with pytest.raises(ValueError, match="asked no times"):
        timed_poses(walk([0, 4], [np.nan, np.nan], np.arange(9.0)))
