import itertools

import numpy as np
import pytest
from scipy.sparse.csgraph import floyd_warshall

from reperform.nodes.kernels.shortest_paths import shortest_path
from reperform.nodes.motion_graph.essential import essential
from reperform.nodes.motion_graph.pose_edges import complete_digraph


def test_best_paths_are_those_of_the_complete_digraph(pose_pairs):
    graph = essential(pose_pairs)
    cost = complete_digraph(pose_pairs, "test").cost.copy()
    np.fill_diagonal(cost, 0)
    np.testing.assert_allclose(graph.distance, floyd_warshall(cost), rtol=1e-9)
    assert graph.frames.tolist() == [20, 13, 9]
    assert len(graph.source) < 0.5 * cost.size


def test_edges_carry_their_transitions(pose_pairs):
    graph = essential(pose_pairs)
    np.testing.assert_allclose(graph.cost, graph.deformation + 0.05 * graph.duration, rtol=1e-6)
    played = graph.source_length == 0
    assert (graph.target - graph.source)[played].tolist() == [1] * int(played.sum())
    # frames follow each other within takes but not from one to the next
    assert {19, 32}.isdisjoint(graph.source[played].tolist())
    k = int(np.flatnonzero((graph.source < 20) & (graph.target >= 33))[0])
    pair, i, j = pose_pairs["a", "c"], graph.source[k], graph.target[k] - 33
    assert graph.duration[k] == pair.duration[i, j]
    assert (graph.source_length[k], graph.target_length[k]) == (
        pair.source_length[i, j],
        pair.target_length[i, j],
    )


def test_predecessors_walk_edges_of_the_graph(pose_pairs):
    graph = essential(pose_pairs)
    edges = dict(
        zip(zip(graph.source.tolist(), graph.target.tolist(), strict=True), graph.cost.tolist(), strict=True)
    )
    for start, end in ((0, 41), (41, 0), (25, 3)):
        path = shortest_path(graph.predecessor, start, end)
        total = sum(edges[a, b] for a, b in itertools.pairwise(path))
        assert total == pytest.approx(graph.distance[start, end])


def test_one_take_alone_is_a_graph_too(pose_pairs):
    graph = essential({("a", "a"): pose_pairs["a", "a"]})
    assert np.isfinite(graph.distance).all()


def test_missing_and_mixed_pairs_are_refused(pose_pairs):
    some = {pair: product for pair, product in pose_pairs.items() if pair != ("b", "c")}
    with pytest.raises(ValueError, match="missing: b to c"):
        essential(some)
    mixed = pose_pairs | {("c", "c"): pose_pairs["c", "c"]._replace(alpha=np.array(0.5))}
    with pytest.raises(ValueError, match="share alpha"):
        essential(mixed)
