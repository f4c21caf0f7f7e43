import numpy as np
import pytest

from reperform.nodes.kernels.curve_reach import curve_reach, distance_left
from reperform.nodes.kernels.graph_moves import graph_moves

RANDOM = np.random.default_rng(5)
POSE = RANDOM.normal(size=(7, 3)) * (0.2, 0.5, 0.3)


def take(steps):
    """A body that goes these ways, m, straight on."""
    at = np.concatenate([[0.0], np.cumsum(steps)])
    return np.stack([POSE + (0.6 * z, 0.0, 0.8 * z) for z in at])


def test_reach_is_the_longest_way_through_all_walks():
    takes = [take([0.01, 0.02, 0.3, 0.05]), take([0.2, 0.2, 0.3])]
    path = np.column_stack([0 + np.arange(3), 5 + np.arange(3)])
    moves = graph_moves(takes, [(0, 7, 0.4, path)], 0.05)
    reach = curve_reach(moves, 5)

    def longest(frame, frames):
        ways = [0.0]
        for e in range(moves.leaving[frame], moves.leaving[frame + 1]):
            rows = moves.middle[moves.first[e] : moves.first[e + 1], [0, 2]]
            played = min(frames, len(rows) - 1)
            way = np.linalg.norm(np.diff(rows, axis=0), axis=1)[:played].sum()
            ways.append(way + (longest(moves.target[e], frames - played) if played else 0.0))
        return max(ways)

    expected = [[longest(i, k) for k in range(6)] for i in range(len(moves.leaving) - 1)]
    np.testing.assert_allclose(reach, expected, atol=1e-9)
    # along its own take it comes 0.38 m
    assert reach[0, 4] > 0.39


@pytest.mark.parametrize("seed", range(20))
def test_no_walk_comes_nearer_than_the_bound(seed):
    random = np.random.default_rng(seed)
    step, count = 0.01, 300
    heading = np.cumsum(random.normal(0.0, 0.05, count))
    points = np.concatenate(
        [np.zeros((1, 2)), np.cumsum(step * np.column_stack([np.sin(heading), np.cos(heading)]), axis=0)]
    )
    speed = np.abs(random.normal(0.05, 0.02, 25))
    reach = np.concatenate([[0.0], np.cumsum(speed)])
    s, body = 0.4, points[40] + random.normal(0.0, 0.25, 2)
    bound = distance_left(points, step, 1.2, reach, s, *body)
    for _ in range(200):
        # a walk as fast as can be or slower, towards the curve, away from it, or anywhere
        at, place, total = s, body.copy(), 0.0
        lazy, aim = random.uniform(0.7, 1.0), random.integers(0, 120)
        for own in speed:
            if at >= 1.2:
                break
            goal = points[min(int(at / step) + aim, count)] - place + random.normal(0.0, 0.01, 2)
            place = place + lazy * own * goal / np.linalg.norm(goal)
            at += lazy * own
            k = min(int(at / step), count - 1)
            part = at / step - k
            total += np.linalg.norm((1 - part) * points[k] + part * points[k + 1] - place)
        assert bound <= total + 1e-9


def test_a_body_behind_a_straight_curve_never_catches_up():
    points = np.column_stack([np.zeros(200), 0.01 * np.arange(200)])
    reach = 0.1 * np.arange(8)
    # at arc length 0.5 the body is 0.2 m behind: five frames to the end at 1.0 m
    assert distance_left(points, 0.01, 0.95, reach, 0.5, 0.0, 0.3) == pytest.approx(5 * 0.2)
    # 0.25 m ahead it waits, on the curve after two frames
    assert distance_left(points, 0.01, 0.95, reach, 0.5, 0.0, 0.75) == pytest.approx(0.05)
