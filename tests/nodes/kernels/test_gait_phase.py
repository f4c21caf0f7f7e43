import numpy as np

from reperform.nodes.kernels.gait_phase import gait_phase


def _planted(frames, left, right, stance=7):
    planted = np.zeros((frames, 2), bool)
    for foot, landings in enumerate((left, right)):
        for t in landings:
            planted[t : t + stance, foot] = True
    return planted


def test_whole_at_left_landings_and_half_at_right_ones():
    phase = gait_phase(_planted(50, (5, 25, 45), (15, 35)))
    np.testing.assert_allclose(phase[[5, 15, 25, 35, 45]], [0, 0.5, 1, 1.5, 2])
    np.testing.assert_allclose(np.diff(phase), 0.05)


def test_goes_on_at_the_pace_of_the_last_step():
    phase = gait_phase(_planted(40, (20,), (10, 24)))
    np.testing.assert_allclose(phase[[0, 10, 20, 24, 28]], [0.0, 0.5, 1.0, 1.5, 2.0])


def test_nothing_known_without_two_landings():
    assert np.isnan(gait_phase(_planted(30, (12,), ()))).all()
