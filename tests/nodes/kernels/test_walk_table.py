import numpy as np
import pytest

from reperform.nodes.kernels.every_walk import every_walk, random_graph
from reperform.nodes.kernels.walk_moves import Moves, Spot, lay_out
from reperform.nodes.kernels.walk_table import FINE, NONE, fill_table, least_by_steps, least_cost

KEYS = [Spot(0, 1), Spot(2, 17)]


@pytest.mark.parametrize("seed", [1, 3, 5])
@pytest.mark.parametrize("cell", [0.3, 0.04, 0.002])
@pytest.mark.parametrize("weight", [0.0, 3.3, 1e3])
def test_no_walk_is_cheaper_than_its_cell_says(seed: int, cell: float, weight: float) -> None:
    graph = random_graph(seed)
    every, moves = every_walk(graph, KEYS, 60), lay_out(*graph, KEYS)
    table = fill_table(moves, 60, 9.0, cell, weight)
    for steps, length, cost in zip(every.steps.astype(int), every.length, every.cost, strict=True):
        assert least_cost(table, 0, steps, length, 0.0, 0.0, np.inf) <= cost + 1e-6


@pytest.mark.parametrize("seed", [1, 3, 5])
def test_fine_cells_say_what_the_cheapest_walk_costs(seed: int) -> None:
    graph = random_graph(seed)
    every, moves = every_walk(graph, KEYS, 60), lay_out(*graph, KEYS)
    table = fill_table(moves, 60, 9.0, 1e-3, 3.3)
    for steps, length in zip(every.steps.astype(int), every.length, strict=True):
        alike = (every.steps == steps) & (abs(every.length - length) < 2e-3)
        told = least_cost(table, 0, steps, length, 0.0, 0.0, np.inf)
        assert told == pytest.approx(every.cost[alike].min(), abs=3e-4)
    # and cells without walks are empty
    steps, cells = np.nonzero(table.least[0] != NONE)
    at = cells * table.cell - table.cell / FINE - table.phase[0]
    for t, x in zip(steps, at, strict=True):
        off = every.length[every.steps == t] - x
        assert ((off > -1e-6) & (off < table.cell + 1e-6)).any()


def test_what_is_wanted_off_the_walks_costs_its_distance() -> None:
    graph = random_graph(1)
    every = every_walk(graph, KEYS, 60)
    table = fill_table(lay_out(*graph, KEYS), 60, 9.0, 1e-3, 3.3)
    for t in (20, 33, 47):
        at = every.steps == t
        for wanted in (-2.0, 0.4, 1.1, 2.3, 12.0):
            off = abs(every.length[at] - wanted)
            told = least_cost(table, 0, t, wanted, np.inf, 2.0, np.inf)
            assert told == pytest.approx((every.cost[at] + 2.0 * off).min(initial=np.inf), abs=3e-3)
            near = (every.cost[at] + 2.0 * off)[off <= 0.1].min(initial=np.inf)
            assert least_cost(table, 0, t, wanted, 0.1, 2.0, np.inf) <= near + 1e-6
            assert least_cost(table, 0, t, wanted, 0.1, 2.0, 0.05) <= 0.05


def test_least_costs_by_steps_are_those_of_all_walks() -> None:
    graph = random_graph(3)
    every, moves = every_walk(graph, KEYS, 60), lay_out(*graph, KEYS)
    least = least_by_steps(moves, 60)
    for t in range(61):
        assert least[0, t] == pytest.approx(every.cost[every.steps == t].min(initial=np.inf), abs=1e-6)


def test_a_move_of_no_length_and_a_way_beyond_reach() -> None:
    # two states: the start stays for 1 step, then ends after 2 steps and 0.25 m, or after 3 and 5 m
    moves = Moves(
        np.array([0, 1, 3]), np.array([1, -1, -1]), np.array([1, 2, 3]), np.array([0.0, 0.25, 5.0]),
        np.array([0.1, 0.2, 0.3], np.float32), np.full(3, -1), np.array([0.33, 0.37, 0.37]), np.array([0.37, 0.0, 0.0]),
    )  # fmt: skip
    table = fill_table(moves, 5, 1.0, 0.01, 1.0)
    assert least_cost(table, 0, 3, 0.25, 0.01, 0.0, np.inf) == pytest.approx(0.3, abs=2e-4)
    assert least_cost(table, 0, 3, 0.30, 0.03, 0.0, np.inf) == np.inf
    assert least_cost(table, 0, 4, 5.0, np.inf, 0.0, np.inf) == np.inf
