import numpy as np
import pytest

from reperform.nodes.kernels.every_walk import random_graph, walks
from reperform.nodes.kernels.path_frames import arc_length, ground_track, path_frames
from reperform.nodes.kernels.placed_search import Goal, best_placed
from reperform.nodes.kernels.walk_moves import Spot, Targets, lay_out

KEYS = [Spot(0, 1), Spot(2, 17)]


@pytest.mark.parametrize("seed", [0, 1, 4])
def test_it_ends_as_well_as_the_best_of_all_walks(seed: int) -> None:
    graph, random = random_graph(seed), np.random.default_rng(seed)
    moves = lay_out(*graph, KEYS)
    if not moves.reachable:
        return
    every = []
    for taken, steps in walks(graph.passages, *KEYS, 48):
        frames = path_frames(0, 1, [graph.passages[k] for k in taken], 17)
        track = ground_track(frames, graph.tracks)
        every.append(
            (graph.costs[list(taken)].sum(), arc_length(track), steps, *track[-1], frames.yaw[-1, 0])
        )
    cost, length, steps, x, z, yaw = np.array(every).T
    for _ in range(4):
        chosen = int(random.integers(len(every)))
        targets = Targets(np.nan, float(steps[chosen]), 0.0, 0.1, 1.0, 6.0)
        goal = Goal(np.array([x[chosen], z[chosen]]), yaw[chosen], 10 / 3, 2.0, graph.tracks[2][17])
        turn = abs((yaw - goal.yaw + np.pi) % (2 * np.pi) - np.pi)
        total = (
            cost + targets.miss(length, steps) + 10 / 3 * np.hypot(x - x[chosen], z - z[chosen]) + 2.0 * turn
        )
        total[abs(steps - targets.steps) > 6] = np.inf
        walk = best_placed(moves, graph.passages, targets, goal, 60, 1000)
        assert walk is not None
        assert total.min() - 1e-5 <= walk.cost <= total.min() + 0.2
        assert walk.bound <= total.min() + 1e-6
        frames = path_frames(0, 1, [graph.passages[k] for k in walk.passages], 17)
        end = ground_track(frames, graph.tracks)[-1]
        again = 10 / 3 * np.hypot(*(end - goal.place))
        again += 2.0 * abs((frames.yaw[-1, 0] - goal.yaw + np.pi) % (2 * np.pi) - np.pi)
        again += float(graph.costs[list(walk.passages)].sum()) + float(
            targets.miss(walk.distance, walk.steps)
        )
        assert walk.cost == pytest.approx(again, abs=1e-5)


def test_without_an_end_in_time_there_is_none() -> None:
    graph = random_graph(4)
    goal = Goal(np.zeros(2), np.nan, 1.0, 1.0, graph.tracks[2][17])
    assert (
        best_placed(
            lay_out(*graph, KEYS), graph.passages, Targets(np.nan, 2.0, 0.0, 1.0, 1.0, 1.0), goal, 60, 9
        )
        is None
    )
