import numpy as np
import ot
import pytest

from reperform.nodes.kernels.signatures import common_planes, merged, signatures, single
from reperform.nodes.kernels.turned_transport import (
    distance_bound,
    exact_distances,
    least_distance,
    turned,
    turned_transport,
)

TURNS = 7


def _take(seed, frames=3, count=60):
    rng = np.random.default_rng(seed)
    return signatures(
        [rng.random(count) + 0.01 for _ in range(frames)],
        [rng.normal(size=(count, 6)) * (0.2, 0.5, 0.4, 0.1, 0.2, 0.1) for _ in range(frames)],
    )


def _pot(a, i, b, j):
    x, y = single(a, i), single(b, j)
    return ot.emd2(x.mass, y.mass, np.linalg.norm(x.point[:, None] - y.point[None], axis=2))


def _cells(a, every, count):
    planes = common_planes((a, every), count)
    return merged(a, planes), merged(every, planes)


@pytest.fixture(scope="module")
def takes():
    a, every = _take(0), turned(_take(1), TURNS)
    truth = [[[_pot(a, i, every, 3 * k + j) for k in range(TURNS)] for j in range(3)] for i in range(3)]
    return a, every, np.array(truth)


@pytest.mark.parametrize("count", [1, 8, 30])
def test_bounds_are_never_over_the_distance(takes, count):
    a, every, truth = takes
    cells = _cells(a, every, count)
    bounds = np.array(
        [
            [[distance_bound(a, i, every, 3 * k + j, cells) for k in range(TURNS)] for j in range(3)]
            for i in range(3)
        ]
    )
    assert (bounds <= truth + 1e-12).all()


def test_more_cells_bound_more_closely_and_all_points_reach_the_distance(takes):
    a, every, truth = takes
    gaps = [
        truth[0, 1, 2] - distance_bound(a, 0, every, 3 * 2 + 1, _cells(a, every, count))
        for count in (2, 20, 10_000)
    ]
    assert gaps[0] > gaps[1] > gaps[2]
    np.testing.assert_allclose(gaps[2], 0, atol=1e-10)


@pytest.mark.parametrize("count", [1, 20])
def test_the_least_is_that_of_all_turns_and_bounds_spare_some(takes, count):
    a, every, truth = takes
    cells = _cells(a, every, count)
    found = [[least_distance(a, i, every, j, cells, TURNS) for j in range(3)] for i in range(3)]
    np.testing.assert_allclose([[f[0] for f in row] for row in found], truth.min(axis=2), rtol=1e-10)
    assert [[f[1] for f in row] for row in found] == truth.argmin(axis=2).tolist()
    solved = sum(f[2] for row in found for f in row)
    assert 9 <= solved <= 9 * TURNS
    if count == 20:
        assert solved < 9 * TURNS / 2
    pairs = np.array([[2, 1], [0, 2], [1, 1]])
    np.testing.assert_allclose(
        exact_distances((a, every), cells, TURNS, pairs), truth.min(axis=2)[tuple(pairs.T)], rtol=1e-10
    )


def test_cells_of_single_points_with_a_wide_margin_are_exact(takes):
    a, every, truth = takes
    alone = _cells(a, every, 10_000)
    found = turned_transport(_cells(a, every, 4), _cells(a, every, 8), alone, TURNS, (100.0, 100.0), False)
    np.testing.assert_allclose(found, truth.min(axis=2), rtol=1e-10)
