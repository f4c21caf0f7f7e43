from collections.abc import Iterator

import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import Placement
from reperform.nodes.kernels.key_frame_search import KeyFrameSearch, Spot, Targets
from reperform.nodes.kernels.path_frames import Passage, arc_length, ground_track, path_frames

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


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("via", [False, True])
def test_it_finds_what_trying_every_walk_finds(seed: int, via: bool) -> None:
    passages, costs, tracks = _scene(seed)
    random = np.random.default_rng(100 + seed)
    start, end = Spot(0, 1), Spot(2, 17)
    keys = [start, *([Spot(1, 8)] if via else []), end]
    found = []
    for taken, steps in _walks(passages, start, end, 60):
        frames = path_frames(start.take, start.frame, [passages[k] for k in taken], end.frame)
        assert len(frames.take) == steps + 1
        captured = np.where(frames.weight[:, :1] == 1.0, 1, 0)
        rows = np.concatenate([frames.take[:, :1], frames.frame[:, :1]], axis=1)
        rows[captured[:, 0] == 0] = -1
        if _shows(rows, keys):
            found.append((steps, arc_length(ground_track(frames, tracks)), float(costs[list(taken)].sum())))
    search = KeyFrameSearch.build(passages, costs, tracks, keys)
    assert search.reachable == bool(found)
    if not found:
        return
    steps, lengths, taken_costs = (np.array(column) for column in zip(*found, strict=True))
    for _ in range(8):
        targets = Targets(random.uniform(0.5, 3.0), random.integers(15, 55), 3.3, 0.1, 0.15, 5.0)
        within = (abs(lengths - targets.distance) <= 0.15) & (abs(steps - targets.steps) <= 5)
        walk = search.best(targets, 60, targets.distance + 0.15)
        assert (walk is not None) == bool(within.any())
        if walk is not None:
            exact = (taken_costs + targets.miss(lengths, steps))[within].min()
            assert walk.cost == pytest.approx(exact, abs=1e-6)
            assert walk.bound <= exact + 1e-6
            assert walk.cost - walk.bound < 0.01
        else:
            near = search.nearest(targets, 60, 6.0)
            assert near is not None
            miss = abs(lengths - targets.distance) / 0.15 + abs(steps - targets.steps) / 5
            got = abs(near.distance - targets.distance) / 0.15 + abs(near.steps - targets.steps) / 5
            assert got == pytest.approx(miss.min(), abs=1e-3)


def test_without_targets_the_cheapest_walk_wins() -> None:
    passages, costs, tracks = _scene(1)
    start, end = Spot(0, 1), Spot(2, 17)
    search = KeyFrameSearch.build(passages, costs, tracks, [start, end])
    walk = search.best(Targets(np.nan, np.nan, 1.0, 1.0, 1.0, 1.0), 60, np.inf)
    assert walk is not None
    exact = min(float(costs[list(taken)].sum()) for taken, _ in _walks(passages, start, end, 60))
    assert walk.cost == pytest.approx(exact)
    assert walk.bound == pytest.approx(exact)


def test_loops_are_taken_as_often_as_the_distance_asks() -> None:
    # one straight take of 1 m and a loop from its frame 18 back to its frame 4
    tracks = [np.stack([np.linspace(0, 1, 21), np.zeros(21)], axis=1)]
    loop = Passage(0, 0, 17, 5, 1, Placement(0.0, np.array([0.6, 0.0])))
    search = KeyFrameSearch.build([loop], np.array([0.01], np.float32), tracks, [Spot(0, 0), Spot(0, 20)])
    # straight through: 1 m; each loop: from frame 16 over 18 = 4.. to 6 and on to 16
    for loops in range(4):
        walk = search.best(Targets(1.0 + 0.6 * loops, np.nan, 100.0, 1.0, 0.05, 1.0), 200, 1.05 + 0.6 * loops)
        assert walk is not None
        assert len(walk.passages) == loops
        assert walk.distance == pytest.approx(1.0 + 0.6 * loops)
