import numpy as np
import pytest

from reperform.nodes.kernels.every_walk import every_walk, random_graph
from reperform.nodes.kernels.walk_moves import Spot, Targets, lay_out, least_steps


@pytest.mark.parametrize("seed", [1, 3, 4, 5, 6])
def test_the_least_steps_are_those_of_the_shortest_walk(seed: int) -> None:
    graph, keys = random_graph(seed), [Spot(0, 1), Spot(2, 17)]
    moves = lay_out(*graph, keys)
    assert least_steps(moves)[0] == every_walk(graph, keys, 60).steps.min()
    # and along every move they fall by no more than it takes
    after = np.where(moves.following < 0, 0.0, least_steps(moves)[moves.following])
    assert (least_steps(moves)[moves.origin] <= moves.steps + after).all()


def test_without_a_way_there_are_no_least_steps() -> None:
    moves = lay_out(*random_graph(0), [Spot(0, 1), Spot(2, 17)])
    assert not moves.reachable
    assert np.isinf(least_steps(moves)).all()


def test_what_is_off_is_told_in_tolerances() -> None:
    targets = Targets(4.0, np.nan, 2.0, 1.0, 0.5, 3.0)
    assert targets.off(5.25, 70) == (2.5, 0.0)
    assert targets.miss(5.25, 70) == pytest.approx(2.5)
    assert targets._replace(distance=np.nan, steps=64.0).off(5.25, 70) == (0.0, 2.0)
