import numpy as np
import pytest

from reperform.nodes.evaluate.pose_paths import pose_paths
from reperform.nodes.motion_graph.essential import essential
from reperform.nodes.motion_graph.local_minima import local_minima


def entries(measures) -> dict[str, float]:
    return dict(zip(measures.name.tolist(), measures.value[0].tolist(), strict=True))


def test_the_essential_graph_is_never_dearer_and_equals_the_complete_digraph(pose_pairs):
    found = entries(pose_paths(essential(pose_pairs), local_minima(pose_pairs), pose_pairs))
    assert found["at or below"] == 1
    assert found["equal"] == 1
    assert found["saving"] > 0
    assert 0 < found["kept"] < 0.5
    assert found["poses"] == 42


def test_a_graph_without_some_edges_is_found_out(pose_pairs):
    graph = essential(pose_pairs)
    dearer = graph._replace(distance=graph.distance * 1.5)
    found = entries(pose_paths(dearer, graph, pose_pairs))
    assert found["at or below"] == 0
    assert found["equal"] == 0
    assert found["saving"] == pytest.approx(-0.5)


def test_what_the_baseline_does_not_join_counts_as_dearer_but_not_as_saved(pose_pairs):
    graph = essential(pose_pairs)
    distance = graph.distance.copy()
    distance[:, 5] = np.inf
    found = entries(pose_paths(graph, graph._replace(distance=distance), pose_pairs))
    assert found["at or below"] == 1
    assert found["unreachable"] == pytest.approx(41 / (42 * 41))
    assert found["saving"] == 0


def test_graphs_of_other_poses_are_refused(pose_pairs):
    graph = essential(pose_pairs)
    alone = essential({("a", "a"): pose_pairs["a", "a"]})
    with pytest.raises(ValueError, match="same poses, got 42, 20 and 42"):
        pose_paths(graph, alone, pose_pairs)
