import itertools

import numpy as np
import pytest

from reperform.nodes.kernels.warped_transitions import best_transitions, transition_path

WAYS = [(1, 1), (1, 0), (0, 1)]


def cheapest_path(cost: np.ndarray) -> float:
    """Corner to corner over all permitted paths, each remembered with its last three steps."""
    best = {(0, 0, ()): cost[0, 0]}
    for r, c in itertools.product(*map(range, cost.shape)):
        for (row, column, steps), total in list(best.items()):
            if (row, column) != (r, c):
                continue
            for step in WAYS:
                cell = (r + step[0], c + step[1])
                if cell[0] >= cost.shape[0] or cell[1] >= cost.shape[1]:
                    continue
                if step != (1, 1) and steps == (step,) * 3:
                    continue
                key = (*cell, (*steps, step)[-3:])
                best[key] = min(best.get(key, np.inf), total + cost[cell])
    last = (cost.shape[0] - 1, cost.shape[1] - 1)
    return min((total for key, total in best.items() if key[:2] == last), default=np.inf)


def by_definition(distance: np.ndarray, alpha: float, i: int, j: int, shortest: int, longest: int) -> float:
    """The least over all windows, one after the other."""
    found = np.inf
    for rows in range(shortest, max(shortest, min(longest, len(distance) - i)) + 1):
        for columns in range(shortest, max(shortest, min(longest, j + 1)) + 1):
            r = np.minimum(i + np.arange(rows), len(distance) - 1)
            c = np.maximum(j - columns + 1 + np.arange(columns), 0)
            found = min(found, cheapest_path(distance[np.ix_(r, c)] + alpha) - alpha)
    return found


@pytest.mark.parametrize(
    ("shape", "alpha", "bounds"),
    [((7, 9), 0.1, (2, 4)), ((9, 6), 0.3, (1, 3)), ((2, 3), 0.1, (4, 6)), ((8, 11), 1e-4, (2, 3))],
)
def test_least_over_all_windows_and_warps(shape, alpha, bounds):
    distance = np.random.default_rng(len(shape)).uniform(size=shape) ** 6
    best = best_transitions(distance, alpha, *bounds)
    found = best.deformation + alpha * best.duration
    for i, j in itertools.product(*map(range, shape)):
        assert found[i, j] == pytest.approx(by_definition(distance, alpha, i, j, *bounds), abs=1e-6), (i, j)
    assert best.target_length.max() <= max(bounds)
    assert best.source_length.max() <= max(bounds)
    assert min(best.target_length.min(), best.source_length.min()) >= bounds[0]


def test_a_window_longer_than_permitted_is_not_taken_however_cheap():
    # a channel of nothing that is two frames too long leads to (2, 8)
    distance = np.full((4, 12), 5.0)
    distance[[0, 0, 0, 1, 1, 2, 2, 2], [2, 3, 4, 4, 5, 6, 7, 8]] = 0.0
    best = best_transitions(distance, 1e-3, 2, 5)
    assert best.target_length[0, 8] <= 5
    expected = by_definition(distance, 1e-3, 0, 8, 2, 5)
    assert best.deformation[0, 8] + 1e-3 * best.duration[0, 8] == pytest.approx(expected, abs=1e-5)


def test_the_path_of_a_transition_has_its_cost_and_its_steps():
    distance = np.random.default_rng(3).uniform(size=(13, 12)) ** 3
    best = best_transitions(distance, 0.02, 3, 7)
    for i, j in ((0, 11), (4, 4), (12, 0), (11, 6), (5, 1)):
        rows, columns = int(best.source_length[i, j]), int(best.target_length[i, j])
        path = transition_path(distance, i, j, rows, columns, 0.02)
        assert distance[path[:, 0], path[:, 1]].sum() == pytest.approx(best.deformation[i, j], rel=1e-5)
        assert len(path) == best.duration[i, j] + 1
        assert tuple(path[0]) == (i, max(j - columns + 1, 0))
        assert tuple(path[-1]) == (min(i + rows - 1, 12), j)
        assert (np.diff(path, axis=0) >= 0).all()


def test_a_slower_copy_is_met_at_half_its_pace():
    pose = np.linspace(0.0, 3.0, 40)
    distance = np.abs(pose[None, ::2].T - pose[None])
    best = best_transitions(distance, 1e-3, 6, 15)
    path = transition_path(
        distance, 5, 20, int(best.source_length[5, 20]), int(best.target_length[5, 20]), 1e-3
    )
    assert best.deformation[5, 20] < 1.1
    assert len(path) >= 9
    inner = path[3:-3]
    assert np.abs(2 * inner[:, 0] - inner[:, 1]).max() <= 3


def test_windows_without_a_path_are_refused():
    with pytest.raises(ValueError, match="cannot be warped"):
        transition_path(np.ones((9, 9)), 0, 8, 1, 6, 0.1)
