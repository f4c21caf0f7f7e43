import numpy as np
import pytest
from scipy.optimize import minimize

from reperform.nodes.products.performance import SkeletonSequence
from reperform.nodes.similarity.skeleton import skeleton

NAMES = np.array(["hips", "head", "left_hand", "right_foot"])
PARENTS = np.array([-1, 0, 0, 0], np.int32)


def _take(seed, frames, fps=25):
    joints = np.random.default_rng(seed).normal(size=(frames, 4, 3)) * (0.3, 0.8, 0.2)
    return SkeletonSequence(joints.astype(np.float32), PARENTS, NAMES, np.float32(fps))


def _turn(points, yaw, offset=(0.0, 0.0, 0.0)):
    c, s = np.cos(yaw), np.sin(yaw)
    return points @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T + offset


def test_agrees_with_numerical_minimisation_under_weights():
    a, b = _take(0, 3), _take(1, 4)
    share = np.array([1.0, 3.0, 1.0, 0.5])
    distance = skeleton((a, b), velocity_weight=0.6, weights={"head": 3.0, "right_foot": 0.5}).distance
    u, v = a.joints[2] - a.joints[1], b.joints[3] - b.joints[2]

    def cost(p):
        pose = a.joints[2] - _turn(b.joints[3], p[0], (p[1], 0, p[2]))
        moves = u - _turn(v, p[0])
        return (share[:, None] * (pose**2 + 0.6 * moves**2)).sum() / share.sum()

    best = min(minimize(cost, (yaw, 0, 0)).fun for yaw in (0, 2, 4))
    np.testing.assert_allclose(distance[2, 3], np.sqrt(best), rtol=1e-5)


def test_a_joint_without_weight_does_not_count():
    a = _take(2, 4)
    joints = a.joints.copy()
    joints[:, 2] += (0.5, 0.1, -0.4)
    other = a._replace(joints=_turn(joints, 1.3, (2, 0, 1)).astype(np.float32))
    assert np.diag(skeleton((a, other)).distance).min() > 0.05
    assert np.diag(skeleton((a, other), weights={"left_hand": 0}).distance).max() < 1e-4


def test_refuses_other_joints_rates_and_weights():
    a = _take(0, 3)
    with pytest.raises(ValueError, match="same joints"):
        skeleton((a, a._replace(names=NAMES[::-1])))
    with pytest.raises(ValueError, match="no joint tail; there are hips"):
        skeleton((a, a), weights={"tail": 1.0})
    with pytest.raises(ValueError, match=">= 0"):
        skeleton((a, a), weights={"head": -1.0})
    with pytest.raises(ValueError, match="one frame rate"):
        skeleton((a, _take(0, 3, fps=50)), velocity_weight=1.0)
