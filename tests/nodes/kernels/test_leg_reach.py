from collections.abc import Mapping

import numpy as np
import pytest

from reperform.nodes.kernels.articulation import joint_positions
from reperform.nodes.kernels.leg_reach import leg_of, needed_drop, reach
from reperform.nodes.products.mocap import Mocap


def parts(take: Mocap) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    return (
        take.skeleton.parents,
        take.offset.astype(float),
        take.skeleton.joints.astype(float),
        take.rotation.astype(float),
    )


def test_a_leg_is_the_two_long_bones_above_the_foot(striders: Mapping[str, Mocap]) -> None:
    parents, offset, _, _ = parts(striders["slow"])
    leg = leg_of(8, parents, offset, 1.4)
    assert (leg.hip, leg.knee, leg.ankle, leg.foot.tolist()) == (5, 6, 7, [7, 8])
    with pytest.raises(ValueError, match="two bones of at least"):
        leg_of(1, parents, offset, 1.4)


def test_the_ankle_comes_where_it_is_wanted_and_the_foot_keeps_its_turn(
    striders: Mapping[str, Mocap],
) -> None:
    parents, offset, joints, turn = parts(striders["turning"])
    leg = leg_of(4, parents, offset, 1.4)
    wanted = joints[:, leg.ankle] + np.random.default_rng(5).normal(0, 0.015, (len(joints), 3)) + [0, 0.03, 0]
    bent = turn.copy()
    reach(joints, bent, leg, wanted)
    moved = joint_positions(parents, offset, joints[:, 0], bent)
    np.testing.assert_allclose(moved[:, leg.ankle], wanted, atol=1e-6)
    np.testing.assert_allclose(bent[:, leg.foot], turn[:, leg.foot])
    np.testing.assert_allclose(moved[:, 5:], joints[:, 5:], atol=1e-6)
    np.testing.assert_allclose(
        bent @ np.swapaxes(bent, -1, -2), np.broadcast_to(np.eye(3), bent.shape), atol=1e-6
    )
    # the knee still points forward
    facing = turn[:, 0] @ [0, 0, 1]
    middle = 0.5 * (moved[:, leg.hip] + moved[:, leg.ankle])
    assert (((moved[:, leg.knee] - middle) * facing).sum(axis=1) > 0).all()


def test_where_nothing_is_asked_nothing_moves(striders: Mapping[str, Mocap]) -> None:
    parents, offset, joints, turn = parts(striders["quick"])
    leg, same = leg_of(4, parents, offset, 1.4), turn.copy()
    reach(joints, same, leg, joints[:, leg.ankle])
    np.testing.assert_allclose(same, turn, atol=1e-5)


def test_hips_come_down_as_far_as_the_leg_is_short(striders: Mapping[str, Mocap]) -> None:
    parents, offset, joints, _ = parts(striders["slow"])
    leg = leg_of(4, parents, offset, 1.4)
    wanted = joints[:, leg.ankle].copy()
    assert needed_drop(joints, leg, wanted, 25.0).max() < 1e-9
    wanted[30] = joints[30, leg.hip] - [0, 0.9, 0]
    length = np.linalg.norm(offset[leg.knee]) + np.linalg.norm(offset[leg.ankle])
    drop = needed_drop(joints, leg, wanted, 25.0)
    assert drop[30] == pytest.approx(0.9 - 0.998 * length, abs=1e-5)
    assert (drop[[20, 40]] == 0).all()
