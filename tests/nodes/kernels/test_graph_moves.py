import numpy as np
import pytest

from reperform.nodes.kernels.graph_moves import Moves, graph_moves, play_moves, pose_at
from reperform.nodes.kernels.ground_plane import Placement, apply

RANDOM = np.random.default_rng(5)
POSE = RANDOM.normal(size=(25, 3)) * (0.2, 0.5, 0.3)


def take(frames, speed, heading, start):
    places = np.array(start) + speed * np.arange(frames)[:, None] * [np.sin(heading), np.cos(heading)]
    return np.stack([apply(POSE, Placement(heading, place)) for place in places])


@pytest.fixture(scope="module")
def moves() -> Moves:
    takes = [take(10, 0.05, 0.4, (0, 0)), take(12, 0.08, -1.5, (3, 1))]
    path = np.column_stack([np.arange(3, 8), np.arange(14, 19)])
    return graph_moves(takes, [(3, 18, 0.7, path)], 0.1)


def test_every_frame_is_followed_by_the_next_of_its_take(moves):
    captured = moves.steps == 1
    assert captured.sum() == 9 + 11
    np.testing.assert_array_equal(moves.target[captured], moves.source[captured] + 1)
    assert not ((moves.source == 9) & captured).any()
    for i in range(22):
        assert (moves.source[moves.leaving[i] : moves.leaving[i + 1]] == i).all()


def test_a_transition_plays_its_path_and_arrives_with_all_weight_on_the_target(moves):
    (e,) = np.flatnonzero(moves.steps > 1)
    rows = slice(moves.first[e], moves.first[e + 1])
    assert moves.steps[e] == 4
    np.testing.assert_allclose(
        moves.time[rows], np.column_stack([np.arange(3, 8), np.arange(4, 9)]), atol=1e-9
    )
    np.testing.assert_allclose(moves.weight[rows][[0, 2, -1]], [0, 0.5, 1])


def test_played_moves_walk_on_without_a_jump_wherever_they_start(moves):
    (e,) = np.flatnonzero(moves.steps > 1)
    chain = [
        int(moves.leaving[1]),
        int(moves.leaving[2]),
        int(e),
        int(moves.leaving[18]),
        int(moves.leaving[19]),
    ]
    played = play_moves(moves, chain, 0.8, (1.0, -2.0))
    step = np.linalg.norm(np.diff(played.middle[:, [0, 2]], axis=0), axis=1)
    assert len(played.middle) == 2 + 4 + 2 + 1
    assert (np.diff(step) >= -1e-9).all()
    np.testing.assert_allclose([step[0], step[-1]], [0.05, 0.08], atol=1e-9)
    # both takes show one pose, so the body keeps its direction
    way = np.diff(played.middle[:, [0, 2]], axis=0)
    np.testing.assert_allclose(np.arctan2(way[:, 0], way[:, 1]), 0.4 + 0.8, atol=1e-9)


def test_a_chain_with_a_gap_is_refused(moves):
    with pytest.raises(ValueError, match="not where the one before arrived"):
        play_moves(moves, [int(moves.leaving[1]), int(moves.leaving[4])])


def test_poses_between_frames_are_linear_and_whole_ones_exact():
    frames = RANDOM.normal(size=(4, 3, 3))
    np.testing.assert_array_equal(pose_at(frames, np.array([2.0, 3.0])), frames[[2, 3]])
    np.testing.assert_allclose(pose_at(frames, np.array([0.25]))[0], 0.75 * frames[0] + 0.25 * frames[1])
