import numpy as np
import pytest

from reperform.nodes.kernels.every_walk import every_walk, random_graph
from reperform.nodes.kernels.walk_moves import Moves, Spot, lay_out
from reperform.nodes.kernels.walk_search import search_walk
from reperform.nodes.kernels.walk_table import fill_table

KEYS = [Spot(0, 1), Spot(2, 17)]


@pytest.mark.parametrize("seed", [1, 3, 5, 6])
@pytest.mark.parametrize("cell", [0.5, 0.01])
def test_it_finds_every_walk_that_is_the_cheapest_of_its_length(seed: int, cell: float) -> None:
    graph = random_graph(seed)
    every, moves = every_walk(graph, KEYS, 60), lay_out(*graph, KEYS)
    table = fill_table(moves, 60, 9.0, cell, 3.3)
    for t, wanted in zip(every.steps.astype(int), every.length + 0.013, strict=True):
        at = every.steps == t
        total = every.cost[at] + 3.0 * abs(every.length[at] - wanted)
        edges, cost, _ = search_walk(moves, table, t, wanted, 0.1, 3.0, np.inf, 10_000, 10_000)
        assert cost == pytest.approx(total[abs(every.length[at] - wanted) <= 0.1].min(), abs=1e-6)
        assert moves.steps[edges].sum() == t
        paid = moves.cost[edges].astype(float).sum() + 3.0 * abs(moves.length[edges].sum() - wanted)
        assert cost == pytest.approx(paid)
        # each move starts where the one before ended
        origin = np.repeat(np.arange(len(moves.first) - 1), np.diff(moves.first))
        assert origin[edges[0]] == 0
        np.testing.assert_array_equal(moves.following[edges[:-1]], origin[edges[1:]])
        assert moves.following[edges[-1]] == -1
        # nothing is under its cost
        assert len(search_walk(moves, table, t, wanted, 0.1, 3.0, cost, 10_000, 10_000)[0]) == 0


def test_it_breaks_off_where_labels_run_out() -> None:
    graph = random_graph(5)
    every, moves = every_walk(graph, KEYS, 60), lay_out(*graph, KEYS)
    table, t = fill_table(moves, 60, 9.0, 0.01, 3.3), int(every.steps.max())
    wanted = float(every.length[every.steps == t][0])
    _, _, used = search_walk(moves, table, t, wanted, 9.0, 0.1, np.inf, 10_000, 10_000)
    assert 3 < used < 10_000
    assert search_walk(moves, table, t, wanted, 9.0, 0.1, np.inf, 3, 3)[2] == 3
    assert len(search_walk(moves, table, t, wanted, 9.0, 0.1, np.inf, 10_000, 1)[0]) > 0


def test_loops_in_another_order_are_searched_once() -> None:
    # two loops at one place, 3 steps and 0.1 m, 3 steps and 0.2 m; any order of eight comes to the same
    moves = Moves(
        np.array([0, 1, 4]), np.array([1, 1, 1, -1]), np.array([0, 3, 3, 1]), np.array([0.0, 0.1, 0.2, 0.05]),
        np.array([0.0, 0.1, 0.1, 0.0], np.float32), np.full(4, -1), np.zeros(4), np.zeros(4),
    )  # fmt: skip
    table = fill_table(moves, 30, 3.0, 0.01, 1.0)
    edges, cost, used = search_walk(moves, table, 25, 1.25, 1e-3, 1.0, np.inf, 10_000, 10_000)
    assert np.bincount(edges, minlength=4).tolist() == [1, 4, 4, 1]
    assert cost == pytest.approx(0.8, abs=1e-6)
    # at most (loops of the one kind, loops of the other): 5 x 5 places, each reached by at most two labels
    assert used <= 51


@pytest.mark.parametrize("dear", [1, 2])
def test_of_walks_alike_the_cheapest_stays(dear: int) -> None:
    # two loops of the same steps and length at one place, one of them three times as dear
    cost = np.array([0.0, 0.1, 0.1, 0.0], np.float32)
    cost[dear] = 0.3
    moves = Moves(
        np.array([0, 1, 4]), np.array([1, 1, 1, -1]), np.array([0, 3, 3, 1]), np.array([0.0, 0.1, 0.1, 0.05]),
        cost, np.full(4, -1), np.zeros(4), np.zeros(4),
    )  # fmt: skip
    table = fill_table(moves, 20, 3.0, 0.01, 1.0)
    edges, total, _ = search_walk(moves, table, 16, 0.55, 1e-3, 1.0, np.inf, 10_000, 10_000)
    assert dear not in edges
    assert total == pytest.approx(0.5, abs=1e-6)
