import numpy as np
import pytest

from reperform.nodes.kernels.every_walk import every_walk, random_graph
from reperform.nodes.kernels.ground_plane import Placement
from reperform.nodes.kernels.path_frames import Passage
from reperform.nodes.kernels.prepared_search import PreparedSearch
from reperform.nodes.kernels.walk_moves import Spot, Targets, lay_out


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("via", [False, True])
@pytest.mark.parametrize("cells", [5_000_000, 50_000])
def test_one_table_answers_every_target_as_trying_every_walk_does(seed: int, via: bool, cells: int) -> None:
    graph, random = random_graph(seed), np.random.default_rng(100 + seed)
    keys = [Spot(0, 1), *([Spot(1, 8)] if via else []), Spot(2, 17)]
    every = every_walk(graph, keys, 60)
    moves = lay_out(*graph, keys)
    assert moves.reachable == bool(len(every.steps))
    if not moves.reachable:
        return
    search = PreparedSearch.fill(moves, 60, 6.0, 3.3, cells)
    for _ in range(12):
        targets = Targets(random.uniform(0.5, 3.0), random.integers(15, 55), 3.3, 0.1, 0.15, 5.0)
        exact = every.least(targets)
        answer = search.ask(targets)
        assert answer.proved
        assert (answer.walk is not None) == bool(np.isfinite(exact))
        if answer.walk is not None:
            assert answer.walk.cost == pytest.approx(exact, abs=1e-6)
            assert answer.walk.bound == pytest.approx(exact, abs=1e-6)
        else:
            near = search.nearest(targets)
            assert near is not None
            miss = abs(every.length - targets.distance) / 0.15 + abs(every.steps - targets.steps) / 5
            got = abs(near.distance - targets.distance) / 0.15 + abs(near.steps - targets.steps) / 5
            assert got == pytest.approx(miss.min(), abs=0.01)
            assert np.isnan(near.bound)


@pytest.mark.parametrize("seed", [1, 3, 5, 6])
def test_with_little_effort_the_bound_still_holds(seed: int) -> None:
    graph, keys = random_graph(seed), [Spot(0, 1), Spot(2, 17)]
    every = every_walk(graph, keys, 60)
    search = PreparedSearch.fill(lay_out(*graph, keys), 60, 6.0, 3.3, 2_000)
    gaps = []
    for distance in np.linspace(0.5, 3.0, 12):
        targets = Targets(distance, 35, 3.3, 0.1, 0.3, 8.0)
        exact = every.least(targets)
        if np.isinf(exact):
            continue
        for effort in (0, 3, 10, 30, 100, 400):
            walk = search.ask(targets, effort).walk
            # few labels per step suffice where there is anything to find
            assert walk is not None
            assert walk.bound - 1e-6 <= exact <= walk.cost + 1e-6
            gaps.append(walk.cost - walk.bound)
    assert max(gaps) > 1e-2
    assert min(gaps) == pytest.approx(0.0, abs=1e-6)


def test_bounds_rise_with_effort_and_never_pass_the_cheapest() -> None:
    graph, keys = random_graph(3, (60, 50, 70), 40), [Spot(0, 1), Spot(2, 66)]
    search = PreparedSearch.fill(lay_out(*graph, keys), 330, 36.0, 3.3, 200_000)
    worse = 0
    for distance in (23.0, 24.5, 26.0, 28.0):
        targets = Targets(distance, 300, 3.3, 0.1, 0.05, 2.0)
        full = search.ask(targets, 3_000_000).walk
        assert full is not None
        assert full.bound == pytest.approx(full.cost, abs=1e-9)
        before = -np.inf
        for effort in np.geomspace(10, 30_000, 25).astype(int):
            walk = search.ask(targets, int(effort)).walk
            assert walk is not None
            assert before <= walk.bound <= full.cost + 1e-9 <= walk.cost + 2e-9
            before, worse = walk.bound, worse + (walk.cost > full.cost + 1e-3)
    assert worse > 10


def test_a_table_answers_other_weights_than_its_own() -> None:
    graph, keys = random_graph(1), [Spot(0, 1), Spot(2, 17)]
    every = every_walk(graph, keys, 60)
    for weight in (0.0, 0.5, 50.0):
        search = PreparedSearch.fill(lay_out(*graph, keys), 60, 6.0, weight)
        for distance in np.linspace(0.6, 2.4, 7):
            targets = Targets(distance, 30.0, 5.0, 0.1, 0.15, 5.0)
            walk, exact = search.ask(targets).walk, every.least(targets)
            assert (walk is None) == bool(np.isinf(exact))
            if walk is not None:
                assert walk.cost == pytest.approx(exact, abs=1e-6)


def test_without_targets_the_cheapest_walk_wins() -> None:
    graph, keys = random_graph(1), [Spot(0, 1), Spot(2, 17)]
    search = PreparedSearch.fill(lay_out(*graph, keys), 60, np.inf, 1.0)
    walk = search.ask(Targets(np.nan, np.nan, 1.0, 1.0, 1.0, 1.0)).walk
    assert walk is not None
    every = every_walk(graph, keys, 60)
    assert walk.cost == pytest.approx(every.cost.min())
    assert walk.bound == pytest.approx(every.cost.min())
    assert walk.distance == pytest.approx(every.length[every.cost.argmin()])


def test_time_alone_may_be_asked() -> None:
    graph, keys = random_graph(1), [Spot(0, 1), Spot(2, 17)]
    every = every_walk(graph, keys, 60)
    for reach in (np.inf, 6.0):
        search = PreparedSearch.fill(lay_out(*graph, keys), 60, reach, 1.0)
        for steps in (25.0, 38.0, 52.0):
            targets = Targets(np.nan, steps, 1.0, 0.05, 1.0, 4.0)
            walk = search.ask(targets).walk
            assert walk is not None
            late = abs(every.steps - steps)
            assert walk.cost == pytest.approx((every.cost + 0.05 * late)[late <= 4].min(), abs=1e-6)


def test_loops_are_taken_as_often_as_the_distance_asks() -> None:
    # one straight take of 1 m and a loop from its frame 18 back to its frame 4
    tracks = [np.stack([np.linspace(0, 1, 21), np.zeros(21)], axis=1)]
    loop = Passage(0, 0, 17, 5, 1, Placement(0.0, np.array([0.6, 0.0])))
    moves = lay_out([loop], np.array([0.01], np.float32), tracks, [Spot(0, 0), Spot(0, 20)])
    search = PreparedSearch.fill(moves, 200, 3.0, 100.0)
    # straight through: 1 m; each loop: from frame 16 over 18 = 4.. to 6 and on to 16
    for loops in range(4):
        walk = search.ask(Targets(1.0 + 0.6 * loops, np.nan, 100.0, 1.0, 0.05, 1.0)).walk
        assert walk is not None
        assert len(walk.passages) == loops
        assert walk.distance == pytest.approx(1.0 + 0.6 * loops)
