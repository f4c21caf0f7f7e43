import numpy as np

from reperform.nodes.kernels.hands_apart import hands_apart


def test_the_inner_sides_of_both_hands_are_found():
    """A still body, and two balls of points of radius 0.05 m at different distances; only their insides face."""
    rng = np.random.default_rng(3)
    body = rng.normal(scale=0.2, size=(40, 3))
    ball = rng.normal(size=(30, 3))
    ball *= 0.05 / np.linalg.norm(ball, axis=1, keepdims=True)
    ball[7], ball[11] = [0.05, 0, 0], [-0.05, 0, 0]
    right, left = np.array([0.9, 0.1, 0.5]), np.array([-0.9, 0.1, 0.5])
    poses = np.stack(
        [np.concatenate([body, ball + right * [k, 1, 1], ball + left * [k, 1, 1]]) for k in (0.4, 0.7, 1.0)]
    )
    tip = 40 + int(np.argmax(ball[:, 0]))
    assert hands_apart(poses, tip) == (40 + 11, 70 + 7)
    assert hands_apart(poses, 70) == (70 + 7, 40 + 11)
