"""Which frames tell the motion: by hand, and that they are always known in time."""

import numpy as np

from reperform.nodes.kernels.motion_history import motion_history

# rows 0..4: frames 0..4 of one take, entered at 2; rows 5..8: frames 0..3 of another, entered at 1 from row 4
_TAKE = np.array([0] * 5 + [1] * 4)
_FRAME = np.array([0, 1, 2, 3, 4, 0, 1, 2, 3])
_PARENT = np.array([1, 2, 2, 2, 3, 6, 4, 6, 7])


def _calm(*rows):
    return lambda k: 0.1 if k in rows else 0.2


def test_where_time_runs_two_ways_the_calmer_goes_first():
    before, after = motion_history(_TAKE, _FRAME, _PARENT, 1, _calm(3, 5))
    np.testing.assert_array_equal(before, [2, 3, -1, -1, 2, -1, -1, 5, 6])
    np.testing.assert_array_equal(after, [1, 3, 2, 2, 3, 6, 4, 5, 7])


def test_the_other_way_round():
    before, after = motion_history(_TAKE, _FRAME, _PARENT, 1, _calm(1, 7))
    np.testing.assert_array_equal(before, [2, -1, -1, 1, 2, 7, -1, -1, 6])
    np.testing.assert_array_equal(after, [1, 2, 2, 1, 3, 7, 4, 6, 7])


def test_far_frames_tell_nothing():
    parent, frame = np.array([0, 0, 1, 0]), np.array([10, 13, 14, 9])
    before, after = motion_history(np.zeros(4, int), frame, parent, 2, _calm())
    np.testing.assert_array_equal(before, [-1, -1, -1, -1])
    np.testing.assert_array_equal(after, parent)
    before, _ = motion_history(np.zeros(4, int), frame, parent, 3, _calm(1))
    np.testing.assert_array_equal(before, [-1, -1, 0, 1])


def test_what_tells_the_motion_is_known_in_time():
    random = np.random.default_rng(5)
    for _ in range(20):
        take, frame = np.repeat([0, 1, 2], 12), np.tile(random.permutation(12), 3)
        parent = np.array([0, *(random.integers(0, k) for k in range(1, 36))])
        change = random.random(36)
        before, after = motion_history(take, frame, parent, 4, change.__getitem__)
        for k in range(1, 36):
            known, at = set(), k
            while at != after[at]:
                at = int(after[at])
                known.add(at)
            assert int(parent[k]) in known
            if before[k] >= 0:
                assert int(before[k]) in known
                # on the other side of the parent in time
                assert (frame[before[k]] < frame[parent[k]]) == (frame[parent[k]] < frame[k])
