"""Limbs by bones, and limbs that changed sides."""

import numpy as np
import pytest

from reperform.nodes.kernels.limb_swap import limb_pairs, nearest_bone, swapped_limbs

NAMES = np.array(["hips", "left_thigh", "left_shin", "right_thigh", "right_shin", "head"])
PARENTS = np.array([-1, 0, 1, 0, 3, 0])
JOINTS = np.array(
    [[0, 0.95, 0], [0.1, 0.9, 0], [0.12, 0.5, 0.02], [-0.1, 0.9, 0], [-0.13, 0.5, 0], [0, 1.5, 0]]
)


@pytest.mark.parametrize(
    ("names", "pairs"),
    [
        (NAMES, [("thigh", 1, 3), ("shin", 2, 4)]),
        (np.array(["hand_r", "head", "hand_l"]), [("hand", 2, 0)]),
        (np.array(["Hips", "LeftUpLeg", "RightUpLeg"]), [("UpLeg", 1, 2)]),
        (np.array(["spine", "left_only"]), []),
    ],
)
def test_pairs_are_found_by_name(names, pairs):
    assert limb_pairs(names) == pairs


def test_points_belong_to_the_bone_they_lie_at():
    points = np.array([[0.11, 0.7, 0.05], [0.12, 0.44, 0], [-0.14, 0.6, 0.1], [0.02, 1.6, 0], [0, 1.2, 0.1]])
    assert NAMES[nearest_bone(points, JOINTS, PARENTS)].tolist() == [
        "left_thigh", "left_shin", "right_thigh", "head", "hips",
    ]  # fmt: skip


def legs(rng, lateral: float, forward: float, count: int = 300):
    """Points around two legs, which stand `lateral` from the middle, the left `forward` before the right."""
    tube = np.stack(
        [0.07 * np.cos(t := rng.uniform(0, 7, count)), rng.uniform(0.1, 0.9, count), 0.06 * np.sin(t)], axis=1
    )
    left = tube + [lateral, 0, forward]
    right = tube * [1, 1, -1] + [-lateral, 0.01, -forward]
    return np.concatenate([left, right])


SIDE = np.repeat([0, 1], 300)
PAIR = np.array([[0, 1]])


def test_a_right_alignment_has_no_swap_even_where_legs_pass():
    rng = np.random.default_rng(5)
    truth = legs(rng, 0.075, 0.03)
    fat = truth + 0.012 * rng.standard_normal(truth.shape)
    assert not swapped_limbs(fat, SIDE, truth, SIDE, PAIR).any()


def test_legs_taken_for_each_other_are_found():
    rng = np.random.default_rng(6)
    truth = legs(rng, 0.1, 0.2)
    assert swapped_limbs(truth[np.roll(np.arange(600), 300)], SIDE, truth, SIDE, PAIR).tolist() == [
        True,
        True,
    ]


def test_both_limbs_on_one_side_swap_one_of_them():
    rng = np.random.default_rng(7)
    truth = legs(rng, 0.1, 0.2)
    both_left = np.concatenate([truth[:300], truth[:300]])
    assert swapped_limbs(both_left, SIDE, truth, SIDE, PAIR).tolist() == [False, True]


def test_a_limb_without_vertices_is_no_swap():
    truth = legs(np.random.default_rng(8), 0.1, 0.1)
    assert not swapped_limbs(truth, np.full(600, 5), truth, SIDE, PAIR).any()
