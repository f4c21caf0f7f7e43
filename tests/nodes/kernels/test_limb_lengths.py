"""Limbs of a surface: a closed form, how many there are, their scale, bending, and false joins."""

import numpy as np
import pytest

from reperform.nodes.kernels.limb_lengths import limb_lengths


def _blocks(*boxes):
    """The surface of a union of boxes ((x0, y0, z0), (x1, y1, z1)) of unit cubes, one vertex per place."""
    solid = np.zeros((60, 60, 12), bool)
    for low, high in boxes:
        solid[tuple(slice(a, b) for a, b in zip(low, high, strict=True))] = True
    quads = []
    for axis in range(3):
        for side in (0, 1):
            open_side = solid & ~np.roll(solid, 1 - 2 * side, axis)
            first, second = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
            corner = np.argwhere(open_side) + side * np.eye(3, dtype=int)[axis]
            quad = np.stack([corner, corner + first, corner + first + second, corner + second], axis=1)
            quads.append(quad if side else quad[:, ::-1])
    corners = np.concatenate(quads)
    points, index = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    a, b, c, d = index.reshape(-1, 4).T
    return points.astype(float), np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


_TRUNK = ((20, 20, 4), (30, 40, 8))
_HEAD = ((23, 40, 4), (27, 50, 8))
_LEGS = (((20, 3, 4), (24, 20, 8)), ((26, 1, 4), (30, 20, 8)))
_LEFT = (((30, 36, 4), (36, 40, 8)), ((33, 20, 4), (36, 36, 8)))
_RIGHT = (((14, 36, 4), (20, 40, 8)), ((14, 18, 4), (17, 36, 8)))


def test_a_rod_has_two_limbs_of_a_quarter_of_its_length():
    # mean distance to points spread over a line of length l: l / 2 from its ends, l / 4 from its middle
    found = limb_lengths(*_blocks(((5, 5, 5), (55, 6, 6))), 3)
    np.testing.assert_allclose(found[:2], 50 / 4, rtol=0.25)
    assert found[2] < 1


def test_a_figure_has_five_limbs_and_no_more():
    points, faces = _blocks(_TRUNK, _HEAD, *_LEGS, *_LEFT, *_RIGHT)
    found = limb_lengths(points, faces, 8)
    assert (found[:5] > 5).all()
    assert (found[5:] < found[4] / 3).all()
    assert (np.diff(found) <= 0).all()


def test_lengths_are_lengths():
    points, faces = _blocks(_TRUNK, _HEAD, *_LEGS, *_LEFT)
    np.testing.assert_allclose(limb_lengths(0.25 * points, faces, 6), 0.25 * limb_lengths(points, faces, 6))


def test_bending_keeps_limbs():
    stretched = ((14 - 18 + 4, 36, 4), (20, 40, 8))
    bent = limb_lengths(*_blocks(_TRUNK, _HEAD, *_LEGS, *_RIGHT), 4)
    straight = limb_lengths(*_blocks(_TRUNK, _HEAD, *_LEGS, stretched), 4)
    np.testing.assert_allclose(bent, straight, rtol=0.25)


def test_a_hand_on_the_hip_makes_one_limb_shorter():
    free = limb_lengths(*_blocks(_TRUNK, _HEAD, *_LEGS, *_LEFT, *_RIGHT), 6)
    bridge = ((30, 20, 4), (33, 23, 8))
    held = limb_lengths(*_blocks(_TRUNK, _HEAD, *_LEGS, *_LEFT, *_RIGHT, bridge), 6)
    assert held[4] < 0.7 * free[4]
    np.testing.assert_allclose(held[:3], free[:3], rtol=0.2)


def test_an_arm_within_the_clothes_is_no_limb():
    clothes = ((30, 20, 4), (36, 36, 8))
    found = limb_lengths(*_blocks(_TRUNK, _HEAD, *_LEGS, *_LEFT, *_RIGHT, clothes), 6)
    assert (found[:4] > 5).all()
    assert found[4] < found[3] / 2


@pytest.mark.parametrize("count", [1, 40])
def test_it_gives_as_many_as_asked(count):
    points, faces = _blocks(((5, 5, 5), (8, 6, 6)))
    found = limb_lengths(points, faces, count)
    assert found.shape == (count,)
    assert (found[4:] == 0).all()
