from collections.abc import Mapping

import numpy as np
import pytest

from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph
from reperform.nodes.synthesis.key_frames import key_frames
from reperform.nodes.synthesis.target_grid import target_grid

SPAN = {"distances": (3.0, 9.0, 3.0), "durations": (3.0, 8.0, 2.5)}


def test_it_answers_as_one_target_at_a_time_does(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence]
) -> None:
    grid = target_grid(
        graph, meshes, keys=("slow:3 > turn:40", "slow:3 > fast:30 > slow:60"), **SPAN, cells=20.0
    )
    assert grid.status.shape == (2, 3, 3)
    assert set(np.unique(grid.status)) == {0, 1}
    for s, (start, *via, end) in enumerate((("slow:3", "turn:40"), ("slow:3", "fast:30", "slow:60"))):
        for i, distance in enumerate(grid.distance):
            for j, duration in enumerate(grid.duration):
                path = key_frames(
                    graph, meshes, start=start, via=tuple(via), end=end, distance=distance,
                    duration=duration, nearest=True,
                )  # fmt: skip
                met = (
                    abs(path.distance[0] - distance) <= 0.05 + 1e-6
                    and abs(path.duration[0] - duration) <= 0.081
                )
                assert grid.status[s, i, j] == int(met)
                if met:
                    assert path.cost >= grid.bound[s, i, j] - 1e-5
                    assert grid.cost[s, i, j] >= path.bound - 1e-5
                    assert abs(grid.reached_distance[s, i, j] - distance) <= 0.05 + 1e-9
                else:
                    assert np.isnan(grid.bound[s, i, j])


def test_what_was_taken_adds_up_to_the_cost(graph: MotionGraph, meshes: Mapping[str, MeshSequence]) -> None:
    grid = target_grid(graph, meshes, keys=("slow:3 > turn:40",), **SPAN, cells=20.0)
    paid = grid.taken @ np.asarray(graph.cost, np.float64)
    late = abs(grid.reached_duration - grid.duration[None, None])
    far = abs(grid.reached_distance - grid.distance[None, :, None])
    np.testing.assert_allclose(grid.cost, paid + far * 10 / 3 + late * 2.5, atol=1e-5)


def test_targets_must_rise(graph: MotionGraph, meshes: Mapping[str, MeshSequence]) -> None:
    with pytest.raises(ValueError, match="distances must be first, last, step"):
        target_grid(graph, meshes, keys=("slow:3 > turn:40",), distances=(5.0, 1.0, 1.0))
