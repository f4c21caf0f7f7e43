import time

import numpy as np
import pytest
from scipy.sparse.csgraph import minimum_spanning_tree

from reperform.nodes.align.shape_tree import shape_tree
from reperform.nodes.products.motion import Dissimilarity


def _pairs(matrix, frames):
    names = [f"take_{k}" for k in range(len(frames))]
    ends = np.cumsum([0, *frames])
    return {
        (a, b): Dissimilarity(matrix[ends[i] : ends[i + 1], ends[j] : ends[j + 1]])
        for i, a in enumerate(names)
        for j, b in enumerate(names)
    }


def _matrix(seed, count):
    points = np.random.default_rng(seed).normal(size=(count, 4))
    return np.linalg.norm(points[:, None] - points[None], axis=2).astype(np.float32)


def test_has_the_weight_of_scipys_tree():
    matrix = _matrix(0, 23)
    tree = shape_tree(_pairs(matrix, [10, 6, 7]), neighbour_factor=1.0)
    np.testing.assert_allclose(tree.distance.sum(), minimum_spanning_tree(matrix).sum(), rtol=1e-6)
    assert list(tree.takes) == ["take_0", "take_1", "take_2"]
    np.testing.assert_array_equal(tree.take, [0] * 10 + [1] * 6 + [2] * 7)
    np.testing.assert_array_equal(tree.frame_index, [*range(10), *range(6), *range(7)])


def test_order_visits_parents_first_and_the_root_is_its_own_parent():
    tree = shape_tree(_pairs(_matrix(1, 30), [30]))
    place = np.empty(30, int)
    place[tree.order] = np.arange(30)
    root = tree.order[0]
    assert tree.parent[root] == root
    assert sorted(tree.order) == list(range(30))
    others = np.delete(np.arange(30), root)
    assert (place[tree.parent[others]] < place[others]).all()


def test_root_is_the_middle_of_a_chain():
    position = np.array([0.0, 1.0, 2.1, 3.3, 4.0, 5.2, 6.1])
    matrix = np.abs(position[:, None] - position[None])
    tree = shape_tree(_pairs(matrix, [3, 4]))
    assert tree.order[0] == 3
    np.testing.assert_array_equal(tree.parent, [1, 2, 3, 3, 3, 4, 5])


def test_root_has_the_least_sum_of_path_lengths():
    matrix = _matrix(2, 12)
    tree = shape_tree(_pairs(matrix, [12]), neighbour_factor=1.0)
    graph = np.full((12, 12), np.inf)
    for child, parent in enumerate(tree.parent):
        graph[child, parent] = graph[parent, child] = matrix[child, parent]
    np.fill_diagonal(graph, 0)
    for k in range(12):
        graph = np.minimum(graph, graph[:, k : k + 1] + graph[k : k + 1])
    assert tree.order[0] == graph.sum(1).argmin()


def test_neighbours_are_favoured():
    matrix = np.full((4, 4), 1.0)
    matrix[0, 2] = matrix[2, 0] = 0.9
    np.fill_diagonal(matrix, 0)
    tree = shape_tree(_pairs(matrix, [4]), neighbour_factor=0.5)
    np.testing.assert_array_equal(np.abs(np.arange(4) - tree.parent).max(), 1)
    np.testing.assert_allclose(np.sort(tree.distance), [0, 1, 1, 1])


def test_refuses_missing_pairs_and_misfits():
    pairs = _pairs(_matrix(3, 7), [3, 4])
    with pytest.raises(ValueError, match=r"missing.*take_1.*take_0"):
        shape_tree({k: v for k, v in pairs.items() if k != ("take_1", "take_0")})
    with pytest.raises(ValueError, match="3 and 4 frames"):
        shape_tree(pairs | {("take_0", "take_1"): Dissimilarity(np.zeros((3, 5), np.float32))})
    with pytest.raises(ValueError, match="finite"):
        shape_tree(pairs | {("take_0", "take_1"): Dissimilarity(np.full((3, 4), np.nan, np.float32))})
    with pytest.raises(ValueError, match="missing all"):
        shape_tree({})


def test_1500_frames_are_quick():
    pairs = _pairs(_matrix(4, 1500), [1000, 500])
    shape_tree(_pairs(_matrix(5, 5), [5]))
    start = time.perf_counter()
    shape_tree(pairs)
    assert time.perf_counter() - start < 2.0
