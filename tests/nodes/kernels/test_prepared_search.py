from collections.abc import Iterator

import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import Placement
from reperform.nodes.kernels.path_frames import Passage, arc_length, ground_track, path_frames
from reperform.nodes.kernels.prepared_search import PreparedSearch
from reperform.nodes.kernels.walk_moves import Spot, Targets, lay_out

FRAMES = (16, 12, 20)


def _scene(seed: int) -> tuple[list[Passage], np.ndarray, list[np.ndarray]]:
    """A random small graph: three takes, random tracks, twelve transitions."""
    random = np.random.default_rng(seed)
    tracks = [np.cumsum(random.uniform(-0.01, 0.08, size=(n, 2)), axis=0) for n in FRAMES]
    passages = []
    while len(passages) < 12:
        source, target = random.integers(3, size=2)
        length = int(random.integers(1, 4))
        m = int(random.integers(length, FRAMES[source] - length))
        n = int(random.integers(length, FRAMES[target] - length))
        placement = Placement(random.uniform(-2, 2), random.normal(size=2) * 0.02)
        passages.append(Passage(int(source), int(target), m, n, length, placement))
    return passages, random.uniform(0.01, 0.3, size=12).astype(np.float32), tracks


def _walks(
    passages: list[Passage], start: Spot, end: Spot, horizon: int
) -> Iterator[tuple[tuple[int, ...], int]]:
    """Every walk of at most `horizon` steps, with its number of steps."""
    pending: list[tuple[tuple[int, ...], int, int, int]] = [((), start.take, start.frame, 0)]
    while pending:
        taken, take, frame, steps = pending.pop()
        if take == end.take and frame <= end.frame and steps + end.frame - frame <= horizon:
            yield taken, steps + end.frame - frame
        for k, passage in enumerate(passages):
            more = steps + passage.departure - frame + 2 * passage.length
            if passage.source == take and passage.departure >= frame and more <= horizon:
                pending.append(((*taken, k), passage.target, passage.arrival, more))


def _shows(frames_of: np.ndarray, keys: list[Spot]) -> bool:
    """Whether captured frames (take, frame) appear in order."""
    place = 0
    for key in keys:
        hits = np.flatnonzero((frames_of[place:] == key).all(axis=1))
        if len(hits) == 0:
            return False
        place += int(hits[0])
    return True


def _found(
    passages: list[Passage], costs: np.ndarray, tracks: list[np.ndarray], keys: list[Spot]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Steps, length and cost of every walk of up to 60 steps that shows the key frames."""
    rows = []
    for taken, steps in _walks(passages, keys[0], keys[-1], 60):
        frames = path_frames(keys[0].take, keys[0].frame, [passages[k] for k in taken], keys[-1].frame)
        assert len(frames.take) == steps + 1
        shown = np.concatenate([frames.take[:, :1], frames.frame[:, :1]], axis=1)
        shown[frames.weight[:, 0] < 1.0] = -1
        if _shows(shown, keys):
            rows.append((steps, arc_length(ground_track(frames, tracks)), float(costs[list(taken)].sum())))
    steps, lengths, paid = np.array(rows).reshape(-1, 3).T
    return steps, lengths, paid


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("via", [False, True])
@pytest.mark.parametrize("cells", [20_000_000, 200_000])
def test_one_table_answers_every_target_as_trying_every_walk_does(seed: int, via: bool, cells: int) -> None:
    passages, costs, tracks = _scene(seed)
    random = np.random.default_rng(100 + seed)
    keys = [Spot(0, 1), *([Spot(1, 8)] if via else []), Spot(2, 17)]
    steps, lengths, paid = _found(passages, costs, tracks, keys)
    moves = lay_out(passages, costs, tracks, keys)
    assert moves.reachable == bool(len(steps))
    if not len(steps):
        return
    search = PreparedSearch.fill(moves, 60, 6.0, 3.3, cells)
    for _ in range(12):
        targets = Targets(random.uniform(0.5, 3.0), random.integers(15, 55), 3.3, 0.1, 0.15, 5.0)
        within = (abs(lengths - targets.distance) <= 0.15) & (abs(steps - targets.steps) <= 5)
        answer = search.ask(targets)
        assert answer.proved
        assert (answer.walk is not None) == bool(within.any())
        if answer.walk is not None:
            exact = (paid + targets.miss(lengths, steps))[within].min()
            assert answer.walk.cost == pytest.approx(exact, abs=1e-6)
            assert answer.walk.bound == pytest.approx(exact, abs=1e-5)
        else:
            near = search.nearest(targets)
            assert near is not None
            miss = abs(lengths - targets.distance) / 0.15 + abs(steps - targets.steps) / 5
            got = abs(near.distance - targets.distance) / 0.15 + abs(near.steps - targets.steps) / 5
            assert got == pytest.approx(miss.min(), abs=0.01 if cells > 1_000_000 else 0.2)


@pytest.mark.parametrize("seed", range(4))
def test_without_effort_the_bound_still_holds(seed: int) -> None:
    passages, costs, tracks = _scene(seed)
    keys = [Spot(0, 1), Spot(2, 17)]
    steps, lengths, paid = _found(passages, costs, tracks, keys)
    search = PreparedSearch.fill(lay_out(passages, costs, tracks, keys), 60, 6.0, 3.3, 50_000)
    for distance in np.linspace(0.5, 3.0, 12):
        targets = Targets(distance, 35, 3.3, 0.1, 0.3, 8.0)
        within = (abs(lengths - distance) <= 0.3) & (abs(steps - 35) <= 8)
        walk = search.ask(targets, effort=0).walk
        if walk is not None:
            exact = (paid + targets.miss(lengths, steps))[within].min()
            assert walk.bound - 1e-5 <= exact <= walk.cost + 1e-6


def test_a_table_refuses_a_greater_weight_than_its_own() -> None:
    passages, costs, tracks = _scene(1)
    search = PreparedSearch.fill(lay_out(passages, costs, tracks, [Spot(0, 1), Spot(2, 17)]), 60, 6.0, 1.0)
    with pytest.raises(ValueError, match="lesser weight of distance"):
        search.ask(Targets(1.0, 30.0, 2.0, 0.1, 0.15, 5.0))


def test_without_targets_the_cheapest_walk_wins() -> None:
    passages, costs, tracks = _scene(1)
    keys = [Spot(0, 1), Spot(2, 17)]
    search = PreparedSearch.fill(lay_out(passages, costs, tracks, keys), 60, np.inf, 1.0)
    walk = search.ask(Targets(np.nan, np.nan, 1.0, 1.0, 1.0, 1.0)).walk
    assert walk is not None
    exact = _found(passages, costs, tracks, keys)[2].min()
    assert walk.cost == pytest.approx(exact)
    assert walk.bound == pytest.approx(exact)


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
