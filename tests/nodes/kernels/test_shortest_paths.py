import networkx
import numpy as np
import pytest
from scipy.sparse.csgraph import floyd_warshall

from reperform.nodes.kernels.shortest_paths import (
    all_distances,
    essential_edges,
    shortest_path,
    sparse_paths,
)


def costs(count: int, seed: int = 0) -> np.ndarray:
    return 0.05 + np.random.default_rng(seed).uniform(size=(count, count)) ** 3


def test_agrees_with_scipy_over_several_blocks():
    cost = costs(150)
    np.fill_diagonal(cost, 0.0)
    np.testing.assert_allclose(all_distances(cost), floyd_warshall(cost), rtol=1e-12)


def test_kept_edges_keep_all_distances_and_none_can_go():
    cost = costs(40, 1)
    distance = all_distances(cost)
    source, target = essential_edges(cost, distance)
    kept, predecessor = sparse_paths(40, source, target, cost[source, target])
    np.testing.assert_allclose(kept, distance, rtol=1e-12)
    for k in range(0, len(source), 7):
        rest = np.delete(np.arange(len(source)), k)
        without, _ = sparse_paths(40, source[rest], target[rest], cost[source[rest], target[rest]])
        assert without[source[k], target[k]] > distance[source[k], target[k]] * (1 + 1e-9)
    for start, end in ((0, 17), (39, 3), (5, 5)):
        path = shortest_path(predecessor, start, end)
        assert (path[0], path[-1]) == (start, end)
        assert cost[path[:-1], path[1:]].sum() == pytest.approx(distance[start, end])


def test_of_equal_ways_the_one_of_more_steps_stays():
    # a chain whose short cuts cost as much as the way along it
    ahead = np.arange(9)[None] - np.arange(9)[:, None]
    cost = np.where(ahead > 0, 0.1 * ahead, 50.0)
    source, target = essential_edges(cost, all_distances(cost))
    chain = [(a, b) for a, b in zip(source, target, strict=True) if b > a]
    assert chain == [(k, k + 1) for k in range(8)]


def test_what_cannot_be_reached_has_no_path():
    source, target = np.array([0, 1], np.int32), np.array([1, 2], np.int32)
    distance, predecessor = sparse_paths(4, source, target, np.array([2.0, 3.0]))
    graph = networkx.DiGraph()
    graph.add_weighted_edges_from([(0, 1, 2.0), (1, 2, 3.0)])
    assert distance[0, 2] == networkx.shortest_path_length(graph, 0, 2, weight="weight")
    assert np.isinf(distance[2, 0])
    assert shortest_path(predecessor, 2, 0) == []
    assert shortest_path(predecessor, 0, 2) == [0, 1, 2]
