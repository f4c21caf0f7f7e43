import numpy as np
import pytest

from reperform.nodes.kernels.play_space import (
    advance,
    place_into,
    planted_share,
    pose_into,
    seconds_between,
    soles_of,
)

RANDOM = np.random.default_rng(8)
WEIGHTS = np.array([0.3, 0.7])


def test_time_passes_at_the_blended_pace():
    seconds = np.array([[0.1, 0.2, 0.3], [0.2, 0.1, 0.5]])
    motion, step = np.zeros((2, 3, 3)), np.zeros(3)
    pace = WEIGHTS @ seconds
    pose = advance(motion, seconds, True, WEIGHTS, 0.5, 0.5 * pace[0] + pace[1] + 0.25 * pace[2], step)
    assert pose == pytest.approx(2.25)
    assert seconds_between(seconds, True, WEIGHTS, 0.5, 2.25) == pytest.approx(
        0.5 * pace[0] + pace[1] + 0.25 * pace[2]
    )
    # round the end, and over two whole rounds
    assert advance(motion, seconds, True, WEIGHTS, 2.25, 0.75 * pace[2], step) % 3 == pytest.approx(
        0.0, abs=1e-9
    )
    assert advance(motion, seconds, True, WEIGHTS, 1.5, 2 * pace.sum(), step) == pytest.approx(1.5)
    assert seconds_between(seconds, True, WEIGHTS, 2.5, 0.5) == pytest.approx(0.5 * (pace[0] + pace[2]))
    # what does not repeat itself stays at its last pose
    assert advance(motion, seconds, False, WEIGHTS, 1.9, 9.0, step) == 2.0


def test_travel_does_not_depend_on_the_steps_in_time_but_for_the_chords():
    seconds = RANDOM.uniform(0.05, 0.1, (2, 8))
    motion = np.concatenate([RANDOM.normal(0, 0.05, (2, 8, 2)), RANDOM.normal(0.02, 0.02, (2, 8, 1))], axis=2)
    whole, part, place = np.zeros(3), np.zeros(3), np.zeros(3)
    advance(motion, seconds, True, WEIGHTS, 0.0, float((WEIGHTS @ seconds)[:5].sum()), whole)
    pose = 0.0
    for k in range(5):
        pose = advance(motion, seconds, True, WEIGHTS, pose, float((WEIGHTS @ seconds)[k]), part)
        c, s = np.cos(place[2]), np.sin(place[2])
        place += (c * part[0] + s * part[1], -s * part[0] + c * part[1], part[2])
    assert pose == pytest.approx(5.0)
    np.testing.assert_allclose(whole, place, atol=1e-9)


def test_meshes_and_contacts_are_blended_and_added():
    inputs = RANDOM.normal(size=(2, 4, 12)).astype(np.float32)
    flat = np.full(12, 7.0, np.float32)
    pose_into(inputs, WEIGHTS, 1.25, 0.6, False, flat)
    pose_into(inputs, WEIGHTS[::-1].copy(), 3.0, 0.4, True, flat)
    at = np.tensordot(WEIGHTS, 0.75 * inputs[:, 1] + 0.25 * inputs[:, 2], 1)
    end = np.tensordot(WEIGHTS[::-1], inputs[:, 3], 1)
    np.testing.assert_allclose(flat, 0.6 * at + 0.4 * end, atol=1e-6)
    share = np.zeros(1)
    planted_share(np.array([[[1.0], [0.0]], [[1.0], [1.0]]]), WEIGHTS, 0.5, 1.0, False, share)
    assert share[0] == pytest.approx(0.5 * 0.3 + 0.7)


def test_the_world_is_a_turn_a_shift_and_what_holds_the_feet():
    flat = RANDOM.normal(size=9).astype(np.float32)
    out, shift = np.zeros((3, 3), np.float32), np.array([[0.1, 0.0, -0.2]])
    place_into(
        flat,
        2.0,
        -1.0,
        np.pi / 2,
        np.array([[0.0, 0.5, 0.0]], np.float32),
        np.array([1]),
        np.array([3]),
        shift,
        out,
    )
    points = flat.reshape(3, 3)
    # facing +z, turned left by a right angle, faces +x
    expected = np.stack([points[:, 2] + 2, points[:, 1], -points[:, 0] - 1], axis=1)
    expected[1] += 0.5 * shift[0]
    np.testing.assert_allclose(out, expected, atol=1e-6)
    sole = np.zeros((1, 3))
    soles_of(
        flat,
        2.0,
        -1.0,
        np.pi / 2,
        np.array([0, 2]),
        np.array([0, 2]),
        np.zeros((2, 3)),
        sole,
        np.zeros((1, 2)),
    )
    x, y, z = points[[0, 2]].mean(axis=0)
    np.testing.assert_allclose(sole[0], [z + 2, y, -x - 1], atol=1e-6)


def test_a_foot_that_rolls_over_its_ball_does_not_slide():
    """Heel and ball; the heel rises about the ball, then all of it is carried along."""
    ball = np.array([0.1, 0.0, 0.4])
    start, vertex = np.array([0, 2]), np.array([0, 1])
    point, sole, slid, moved = np.zeros((2, 3)), np.zeros((1, 3)), np.zeros((1, 2)), []
    for angle, carried in ((0.0, 0.0), (0.25, 0.0), (0.5, 0.0), (0.75, 0.0), (0.75, 0.03)):
        c, s = np.cos(angle), np.sin(angle)
        lifted = ball + [0.0, 0.2 * s, -0.2 * c] + [0.0, 0.0, carried]
        flat = np.concatenate([ball + [0.0, 0.0, carried], lifted]).astype(np.float32)
        soles_of(flat, 2.0, -1.0, np.pi / 2, start, vertex, point, sole, slid)
        moved.append(slid[0].copy())
    np.testing.assert_allclose(moved[1:4], 0.0, atol=1e-6)
    # facing +x
    np.testing.assert_allclose(moved[4], [0.03, 0.0], atol=1e-6)
    np.testing.assert_allclose(sole[0, 0], 2.0 + 0.5 * (0.43 + lifted[2]), atol=1e-6)
