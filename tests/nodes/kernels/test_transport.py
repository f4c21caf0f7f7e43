import numpy as np
import ot
import pytest

from reperform.nodes.kernels.transport import earth_movers, row_potentials


def _problem(rows, columns, seed=0):
    rng = np.random.default_rng(seed)
    supply, demand = rng.random(rows) + 0.01, rng.random(columns) + 0.01
    cost = np.linalg.norm(rng.random((rows, 1, 6)) - rng.random((1, columns, 6)), axis=2)
    return supply / supply.sum(), demand / demand.sum(), cost


@pytest.mark.parametrize("shape", [(1, 1), (1, 6), (6, 1), (7, 9), (60, 45), (130, 150)])
def test_agrees_with_pot(shape):
    problem = _problem(*shape)
    np.testing.assert_allclose(earth_movers(*problem), ot.emd2(*problem), rtol=1e-10)


def test_equal_masses_are_the_assignment_problem():
    from scipy.optimize import linear_sum_assignment

    cost = np.random.default_rng(3).random((40, 40))
    even = np.full(40, 1 / 40)
    rows, columns = linear_sum_assignment(cost)
    np.testing.assert_allclose(earth_movers(even, even, cost), cost[rows, columns].mean(), rtol=1e-10)


def test_on_a_line_it_is_the_distance_of_the_quantiles():
    rng = np.random.default_rng(4)
    x, y = np.sort(rng.random(25)), np.sort(rng.random(25) + 0.3)
    even = np.full(25, 1 / 25)
    order = rng.permutation(25)
    cost = np.abs(x[:, None] - y[order][None])
    np.testing.assert_allclose(earth_movers(even, even, cost), np.abs(x - y).mean(), rtol=1e-10)


def test_integer_masses_with_many_ties():
    supply, demand = np.array([2.0, 2, 2, 2]) / 8, np.array([4.0, 2, 1, 1]) / 8
    cost = np.array([[0, 1, 1, 2], [1, 0, 1, 1], [1, 1, 0, 1], [2, 1, 1, 0.0]])
    np.testing.assert_allclose(earth_movers(supply, demand, cost), ot.emd2(supply, demand, cost), rtol=1e-10)


def test_says_when_a_value_is_passed_and_only_then():
    problem = _problem(50, 60, 5)
    value = ot.emd2(*problem)
    assert earth_movers(*problem, 0.9 * value) == np.inf
    np.testing.assert_allclose(earth_movers(*problem, 1.01 * value), value, rtol=1e-10)


def test_potentials_prove_the_least_cost():
    supply, demand, cost = _problem(40, 55, 6)
    u = row_potentials(supply, demand, cost)
    v = (cost - u[:, None]).min(axis=0)
    np.testing.assert_allclose(supply @ u + demand @ v, ot.emd2(supply, demand, cost), rtol=1e-10)
