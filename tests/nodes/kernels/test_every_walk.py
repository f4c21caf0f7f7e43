import numpy as np
import pytest

from reperform.nodes.kernels.every_walk import SmallGraph, every_walk
from reperform.nodes.kernels.ground_plane import Placement
from reperform.nodes.kernels.path_frames import Passage
from reperform.nodes.kernels.walk_moves import Spot, Targets


def _line(shift: float) -> SmallGraph:
    """One straight take of 1 m, and a loop from its frame 16 back to its frame 6, 0.6 m on each turn."""
    track = np.stack([np.linspace(0, 1, 21), np.zeros(21)], axis=1)
    loop = Passage(0, 0, 17, 5, 1, Placement(0.0, np.array([shift, 0.0])))
    return SmallGraph([loop], np.array([0.25], np.float32), [track])


def test_every_number_of_loops_is_a_walk() -> None:
    every = every_walk(_line(0.6), [Spot(0, 0), Spot(0, 20)], 60)
    np.testing.assert_array_equal(np.sort(every.steps), [20, 32, 44, 56])
    order = np.argsort(every.steps)
    np.testing.assert_allclose(every.length[order], [1.0, 1.6, 2.2, 2.8])
    np.testing.assert_allclose(every.cost[order], [0.0, 0.25, 0.5, 0.75])
    assert every.least(Targets(2.2, 44.0, 1.0, 1.0, 0.1, 2.0)) == pytest.approx(0.5)
    assert np.isinf(every.least(Targets(1.9, 44.0, 1.0, 1.0, 0.1, 2.0)))


def test_key_frames_must_appear_whole_and_in_order() -> None:
    # frame 18 is passed, captured, only on the way out; frame 4 only on the way in
    assert len(every_walk(_line(0.6), [Spot(0, 0), Spot(0, 18), Spot(0, 4), Spot(0, 20)], 60).steps) == 0
    assert len(every_walk(_line(0.6), [Spot(0, 0), Spot(0, 10), Spot(0, 10), Spot(0, 20)], 60).steps) == 4
    assert len(every_walk(_line(0.6), [Spot(0, 0), Spot(0, 15), Spot(0, 8), Spot(0, 20)], 60).steps) == 3
