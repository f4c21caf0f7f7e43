import numpy as np
import pytest

from reperform.nodes.kernels.foot_lock import lock_feet, new_lock

DT = 0.02


def walk(seconds=3.0, slip=0.15, pull=1e9):
    """One foot is put down and taken up again while the motion slips away under it, at `slip` m/s."""
    lock, root = new_lock(1), np.zeros(3)
    time = np.arange(round(seconds / DT)) * DT
    down = (time % 1.0) < 0.6
    sole = np.column_stack([slip * time, 0.02 + 0 * time, 0.1 * time])
    shown, last = [], np.zeros(2)
    for here, planted in zip(sole, down, strict=True):
        natural = here + [root[0], 0.0, root[1]]
        lock_feet(natural[None, [0, 2]] - last, np.array([float(planted)]), lock, DT, 0.2, pull, root)
        shown.append(natural + lock.shift[0])
        last = natural[[0, 2]]
    return np.array(shown), down, sole, root


def test_a_planted_foot_stands_still_until_it_would_be_too_far():
    shown, down, _, _ = walk(seconds=0.5)
    assert down.sum() == len(down)
    np.testing.assert_allclose(shown[:, [0, 2]] - shown[0, [0, 2]], 0, atol=1e-12)
    shown, _, sole, _ = walk(seconds=0.6, slip=0.6)
    assert np.abs(shown - sole).max() < 0.22 + 0.02


def test_nothing_jumps_where_a_foot_is_put_down_or_let_go():
    shown, _, sole, _ = walk(slip=0.05)
    natural = np.abs(np.diff(sole, axis=0)).max()
    assert np.abs(np.diff(shown, axis=0)).max() < natural + 0.012
    # heights are the motion's own
    np.testing.assert_array_equal(shown[:, 1], sole[:, 1])


def test_a_free_foot_comes_back_to_the_motion():
    lock, root = new_lock(1), np.zeros(3)
    lock.shift[0] = (0.1, 0.0, -0.05)
    for _ in range(50):
        lock_feet(np.zeros((1, 2)), np.zeros(1), lock, DT, 0.2, 0.3, root)
    assert np.abs(lock.shift).max() < 1e-3
    # the exact solution does not depend on the step
    one, two = new_lock(1), new_lock(1)
    for lock, steps in ((one, 1), (two, 7)):
        lock.shift[0, 0], lock.rate[0, 0] = 0.1, -0.4
        for _ in range(steps):
            lock_feet(np.zeros((1, 2)), np.zeros(1), lock, 0.14 / steps, 0.2, 0.3, root)
    assert one.shift[0, 0] == pytest.approx(two.shift[0, 0], abs=1e-12)


def test_the_root_is_drawn_after_the_feet_beyond_what_legs_give():
    shown, _, sole, root = walk(seconds=0.58, pull=0.1, slip=0.4)
    # the motion slips to +x and +z: the root goes back, and the foot stays within reach of the motion
    assert root[0] < -0.1
    assert root[1] < -0.02
    reach = np.linalg.norm((shown - sole)[-1, [0, 2]] - root[:2])
    assert 0.05 < reach < 0.1
    _, _, _, still = walk(seconds=0.3, pull=0.1, slip=0.1)
    assert not still.any()
