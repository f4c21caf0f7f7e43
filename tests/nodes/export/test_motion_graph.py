"""Motion graphs read back as what they are."""

import json
from pathlib import Path

import networkx
import numpy as np
import pytest

from reperform.nodes.export.export import endings, write
from reperform.nodes.motion_graph.network import network
from reperform.nodes.products.motion import MotionGraph


@pytest.fixture
def graph() -> MotionGraph:
    two = np.int32([5, 9])
    return MotionGraph(
        np.array(["stand", "walk"]), np.int32([30, 40]), np.int32([0, 0]), np.int32([1, 1]), two, two + 3,
        np.int32([3, 4]), np.float32([0.25, 0.5]), np.array([0.1, -2.0]), np.array([[0.5, 1.0], [2.0, 3.0]]),
        np.array([True, False]), np.float32(25),
    )  # fmt: skip


@pytest.mark.parametrize("ending", [".json", ".graphml"])
def test_it_reads_back_the_same(tmp_path: Path, graph: MotionGraph, ending: str) -> None:
    path = tmp_path / f"graph{ending}"
    assert ending in endings(MotionGraph)
    write(graph, path)
    if ending == ".json":
        back = networkx.node_link_graph(json.loads(path.read_text()), edges="edges")
    else:
        back = networkx.read_graphml(path, force_multigraph=True)
    expected = network(graph)
    assert dict(back.nodes(data=True)) == dict(expected.nodes(data=True))
    assert sorted(data["m"] for *_, data in back.edges(data=True)) == [5, 9]
    rows = sorted((a, b, *sorted(data.items())) for a, b, data in back.edges(data=True))
    assert rows == sorted((a, b, *sorted(data.items())) for a, b, data in expected.edges(data=True))
    assert back.graph["fps"] == 25.0
