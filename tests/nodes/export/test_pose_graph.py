import json

import networkx
import pytest

from reperform.nodes.export.export import endings, write
from reperform.nodes.motion_graph.local_minima import local_minima
from reperform.nodes.products.essential import PoseGraph


def test_poses_come_back_from_both_formats(tmp_path, pose_pairs):
    graph = local_minima(pose_pairs)
    write(graph, tmp_path / "poses.json")
    write(graph, tmp_path / "poses.graphml")
    text = json.loads((tmp_path / "poses.json").read_text())
    from_json = networkx.node_link_graph(text, edges="edges")
    from_xml = networkx.read_graphml(tmp_path / "poses.graphml", node_type=int)
    for back in (from_json, from_xml):
        assert back.number_of_nodes() == 42
        edges = {(a, b): cost for a, b, cost in back.edges(data="cost")}
        expected = zip(graph.source.tolist(), graph.target.tolist(), graph.cost.tolist(), strict=True)
        assert edges == {(a, b): pytest.approx(cost) for a, b, cost in expected}
        assert back.nodes[33]["take"] == "c"


def test_only_these_formats():
    assert set(endings(PoseGraph)) == {".json", ".graphml", ".npz"}
