"""The shortest path against brute force over all paths, and the warp along it."""

import numpy as np
import pytest

from reperform.nodes.kernels.time_warp import continuous_warp, shortest_warp, warped_distance

NO_KEYS = np.zeros((0, 2), np.int64)


def every_path(n: int, m: int) -> list[list[tuple[int, int]]]:
    """All monotone paths from corner to corner."""
    if n == 0 and m == 0:
        return [[(0, 0)]]
    before = [(n - 1, m - 1), (n - 1, m), (n, m - 1)]
    return [[*path, (n, m)] for i, j in before if min(i, j) >= 0 for path in every_path(i, j)]


def test_no_path_is_shorter():
    distance = np.random.default_rng(2).random((5, 4))
    path, mean = shortest_warp(distance, NO_KEYS)
    sums = [sum(distance[cell] for cell in other) for other in every_path(4, 3)]
    assert distance[path[:, 0], path[:, 1]].sum() == pytest.approx(min(sums))
    assert mean == pytest.approx(min(sums) / len(path))


def test_no_path_through_a_key_is_shorter():
    distance = np.random.default_rng(8).random((5, 4))
    path, _ = shortest_warp(distance, np.array([[3, 1]]))
    sums = [sum(distance[cell] for cell in other) for other in every_path(4, 3) if (3, 1) in other]
    assert distance[path[:, 0], path[:, 1]].sum() == pytest.approx(min(sums))
    assert [3, 1] in path.tolist()


def test_the_warp_is_monotone_and_meets_ends_and_keys():
    distance = np.random.default_rng(5).random((40, 29))
    keys = np.array([[9, 14], [30, 20]])
    path, _ = shortest_warp(distance, keys)
    warp = continuous_warp(path, keys)
    assert warp[[0, 9, 30, 39]].tolist() == [0, 14, 20, 28]
    assert (np.diff(warp) > 0).all()


def test_a_straight_path_stays_straight():
    i = np.arange(20)
    path, _ = shortest_warp(np.abs(i[:, None] - i[None]).astype(float), NO_KEYS)
    assert continuous_warp(path, NO_KEYS) == pytest.approx(i)


def test_keys_that_go_back_are_refused():
    with pytest.raises(ValueError, match="must rise"):
        shortest_warp(np.zeros((9, 9)), np.array([[5, 4], [6, 3]]))


def test_a_part_of_a_circle_is_found_whatever_its_pace():
    circle = np.exp(2j * np.pi * np.arange(48) / 48)
    part = np.exp(2j * np.pi * (np.linspace(40, 60, 15)) / 48)
    assert warped_distance(np.abs(part[:, None] - circle[None])) < 0.05
    # backwards it is not there
    assert warped_distance(np.abs(part[::-1, None] - circle[None])) > 0.2
