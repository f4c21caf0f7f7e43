import networkx
import pytest

from reperform.nodes.motion_graph.essential import essential
from reperform.nodes.motion_graph.pose_network import pose_network


def test_best_paths_are_those_of_the_graph(pose_pairs):
    graph = essential(pose_pairs)
    made = pose_network(graph)
    assert made.nodes[20] == {"take": "b", "frame": 0}
    assert made.nodes[41] == {"take": "c", "frame": 8}
    assert made.graph == {"alpha": 0.05, "fps": 12.0}
    for start, end in ((0, 41), (33, 7)):
        length = networkx.shortest_path_length(made, start, end, weight="cost")
        assert length == pytest.approx(graph.distance[start, end])
