import numpy as np
import pytest

from reperform.nodes.evaluate.curve_walk import curve_walk
from reperform.nodes.products.pose_walk import PoseWalk


def walk(shown, off):
    """One step of 0.1 m a frame along +z, `off` m beside it; `shown` names the take of each frame."""
    takes = sorted(set(shown))
    number = np.array([[takes.index(name)] * 2 for name in shown], np.int32)
    count = len(shown)
    wanted = np.column_stack([np.zeros(count), np.full(count, np.nan), 0.1 * np.arange(count)])
    middle = wanted + [off, 0, 0]
    middle[:, 1] = 0.9
    none = np.zeros(0)
    return PoseWalk(
        np.array(takes), number, np.zeros((count, 2)), np.tile([1.0, 0.0], (count, 1)), np.zeros((count, 2)),
        np.zeros((count, 2, 2)), middle, wanted, none.astype(np.int32), none, none.astype(np.int32), np.array(1.0),
        np.array(0.5), np.array(3), np.float32(25),
    )  # fmt: skip


def test_distance_is_that_beside_the_curve():
    (row,) = curve_walk(walk(["a"] * 9, 0.07)).value
    np.testing.assert_allclose(row[:2], 0.07)
    assert np.isnan(row[2])


def test_actions_count_where_they_fill_their_stretch():
    shown = ["walk"] * 10 + ["jump"] * 6 + ["walk"] * 5
    (row,) = curve_walk(walk(shown, 0.0), actions=("0-0.85 walk", "0.95-1.45 jump", "1.4-1.8 walk")).value
    np.testing.assert_allclose(row[2], 2 / 3)


def test_overlapping_actions_may_share_frames():
    shown = ["walk"] * 10 + ["jump"] * 6
    (row,) = curve_walk(walk(shown, 0.0), actions=("0-1.2 walk", "0.5-1.5 jump")).value
    assert row[2] == 1.0


def test_a_walk_along_no_curve_is_refused():
    free = walk(["a"] * 4, 0.0)
    with pytest.raises(ValueError, match="followed no curve"):
        curve_walk(free._replace(wanted=np.full_like(free.wanted, np.nan)))
