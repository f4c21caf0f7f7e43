import numpy as np

from reperform.nodes.kernels.planted_feet import planted_feet


def test_low_and_slow_feet_are_planted():
    feet = np.zeros((20, 2, 3))
    feet[:, 0, 2] = np.arange(20) * 0.1
    feet[10:, 1, 1] = 0.3
    planted = planted_feet(feet, 25.0)
    assert not planted[:, 0].any()
    assert planted[:9, 1].all() and not planted[11:, 1].any()


def test_one_frame_is_judged_by_height():
    assert planted_feet(np.zeros((1, 2, 3)), 25.0).all()
