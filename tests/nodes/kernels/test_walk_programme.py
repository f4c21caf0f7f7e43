import numpy as np
import pytest

from reperform.nodes.kernels.every_walk import every_walk, random_graph
from reperform.nodes.kernels.ground_plane import Placement
from reperform.nodes.kernels.path_frames import Passage, arc_length, ground_track, path_frames
from reperform.nodes.kernels.walk_moves import Spot, Targets, lay_out
from reperform.nodes.kernels.walk_programme import enumerate_pieces, solve_programme

KEYS = [Spot(0, 1), Spot(2, 17)]


@pytest.mark.parametrize("seed", range(6))
def test_it_finds_what_trying_every_walk_finds(seed: int) -> None:
    graph, random = random_graph(seed), np.random.default_rng(50 + seed)
    moves = lay_out(*graph, KEYS)
    if not moves.reachable:
        return
    every, pieces = every_walk(graph, KEYS, 60), enumerate_pieces(moves, 60, 1000, 1000)
    for _ in range(6):
        targets = Targets(random.uniform(0.5, 3.0), float(random.integers(15, 52)), 3.3, 0.1, 0.15, 5.0)
        walk, exact = solve_programme(moves, pieces, targets), every.least(targets)
        assert (walk is not None) == bool(np.isfinite(exact))
        if walk is not None:
            assert walk.cost == pytest.approx(exact, abs=1e-6)
            frames = path_frames(0, 1, [graph.passages[k] for k in walk.passages], 17)
            assert arc_length(ground_track(frames, graph.tracks)) == pytest.approx(walk.distance)
            assert len(frames.take) == walk.steps + 1


def test_a_loop_beyond_another_needs_that_other() -> None:
    # take 1 loops in itself for nothing but is reached only by a dear loop from take 0
    track = np.stack([np.linspace(0, 1, 41), np.zeros(41)], axis=1)
    here = Placement(0.0, np.zeros(2))
    passages = [
        Passage(0, 1, 20, 6, 1, here), Passage(1, 0, 34, 6, 1, here), Passage(1, 1, 29, 11, 1, here),
    ]  # fmt: skip
    costs = np.array([0.5, 0.5, 0.01], np.float32)
    moves = lay_out(passages, costs, [track, track], [Spot(0, 0), Spot(0, 40)])
    pieces = enumerate_pieces(moves, 300, 100, 100)
    for loops in range(1, 4):
        asked = 82.0 + 18 * loops
        walk = solve_programme(moves, pieces, Targets(np.nan, asked, 0.0, 1.0, 1.0, 1.0))
        assert walk is not None
        assert (walk.passages.count(0), walk.passages.count(1), walk.passages.count(2)) == (1, 1, loops)
        assert walk.cost == pytest.approx(1.0 + 0.01 * loops, abs=1e-6)
    assert solve_programme(moves, pieces, Targets(np.nan, 60.0, 0.0, 1.0, 1.0, 1.0)) is None


def test_too_many_pieces_are_refused() -> None:
    moves = lay_out(*random_graph(5), KEYS)
    with pytest.raises(ValueError, match="loop-free walks"):
        enumerate_pieces(moves, 60, 1, 1000)
    with pytest.raises(ValueError, match="loops: keep fewer"):
        enumerate_pieces(moves, 60, 1000, 1)


def test_time_that_runs_out_is_said() -> None:
    moves = lay_out(*random_graph(5), KEYS)
    targets = Targets(1.5, 40.0, 3.3, 0.1, 0.5, 15.0)
    with pytest.raises(TimeoutError, match="longer than allowed"):
        solve_programme(moves, enumerate_pieces(moves, 60, 1000, 1000), targets, seconds=0.0)
