import itertools

import numpy as np

from reperform.nodes.kernels.graph_moves import Moves
from reperform.nodes.kernels.timed_walk import TimedWalk, Unreachable, timed_walk

COUNT = 9


def graph() -> Moves:
    """Two takes of frames 0-4 and 5-8 with random transitions."""
    rows = [(i, i + 1, 1, 0.1) for i in range(COUNT - 1) if i != 4]
    random = np.random.default_rng(8)
    for _ in range(18):
        source, target = random.integers(COUNT, size=2)
        rows.append((int(source), int(target), int(random.integers(2, 5)), float(random.uniform(0.2, 2.0))))
    rows.sort()
    source, target, steps, cost = (np.array(column) for column in zip(*rows, strict=True))
    none = np.zeros(0)
    return Moves(
        np.searchsorted(source, np.arange(COUNT + 1)),
        source,
        target,
        steps,
        cost,
        none,
        none,
        none,
        none,
        none,
        none,
        none,
    )


def every_walk(moves: Moves, node: int, goal: int, steps: int):
    """All walks of exactly `steps` frames, as (cost, chain)."""
    if steps == 0:
        return [(0.0, ())] if node == goal else []
    found = []
    for e in range(moves.leaving[node], moves.leaving[node + 1]):
        if moves.steps[e] <= steps:
            for cost, chain in every_walk(moves, int(moves.target[e]), goal, steps - int(moves.steps[e])):
                found.append((cost + float(moves.cost[e]), (e, *chain)))
    return found


def brute_force(moves, poses, times, tolerance, weight):
    best = np.inf
    windows = [range(max(t - tolerance, 0), t + tolerance + 1) for t in times[1:]]
    for shown in itertools.product(*windows):
        whole = (0, *shown)
        total = weight * sum(abs(s - t) for s, t in zip(whole, times, strict=True))
        for k in range(1, len(poses)):
            costs = (
                [cost for cost, _ in every_walk(moves, poses[k - 1], poses[k], whole[k] - whole[k - 1])]
                if whole[k] >= whole[k - 1]
                else []
            )
            total += min(costs, default=np.inf)
        best = min(best, total)
    return best


def test_no_walk_of_all_is_cheaper():
    moves = graph()
    poses, times = (1, 7, 3), (0, 6, 11)
    walk = timed_walk(moves, np.array(poses), np.array(times), 2, 0.3)
    assert isinstance(walk, TimedWalk)
    np.testing.assert_allclose(walk.cost, brute_force(moves, poses, times, 2, 0.3))


def test_the_walk_is_what_it_says():
    moves = graph()
    walk = timed_walk(moves, np.array([1, 7, 3]), np.array([0, 6, 11]), 2, 0.3)
    assert isinstance(walk, TimedWalk)
    chain = np.array(walk.chain)
    np.testing.assert_array_equal(moves.source[chain[1:]], moves.target[chain[:-1]])
    assert moves.source[chain[0]] == 1
    assert moves.target[chain[-1]] == 3
    assert moves.steps[chain].sum() == walk.shown[-1]
    late = sum(abs(a - b) for a, b in zip(walk.shown, (0, 6, 11), strict=True))
    np.testing.assert_allclose(moves.cost[chain].sum() + 0.3 * late, walk.cost)


def test_what_cannot_be_in_time_is_named_with_when_it_could_be():
    moves = graph()
    walk = timed_walk(moves, np.array([0, 4]), np.array([0, 1]), 0, 0.3)
    assert isinstance(walk, Unreachable)
    assert walk.pose == 1
    assert all(every_walk(moves, 0, 4, t) for t in walk.instead)
    assert walk.instead
