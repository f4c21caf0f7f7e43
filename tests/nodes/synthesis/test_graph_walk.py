from collections.abc import Mapping

import numpy as np
import pytest

from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph
from reperform.nodes.synthesis.graph_walk import ground_tracks, passages_of


def test_passages_say_what_the_graph_says(graph: MotionGraph) -> None:
    passages = passages_of(graph)
    assert [p.m for p in passages] == graph.source_frame.tolist()
    assert all(p.departure == p.m - p.length and p.arrival == p.n + p.length for p in passages)
    assert [p.placement.yaw for p in passages] == graph.yaw.tolist()


def test_a_graph_of_other_takes_is_refused(graph: MotionGraph, meshes: Mapping[str, MeshSequence]) -> None:
    assert [len(track) for track in ground_tracks(graph, meshes, "t")] == [70, 60, 65]
    with pytest.raises(ValueError, match="has take 'fast'"):
        ground_tracks(graph, {"slow": meshes["slow"], "turn": meshes["turn"]}, "t")
    short = meshes["slow"]._replace(vertices=np.asarray(meshes["slow"].vertices)[:-1])
    with pytest.raises(ValueError, match="70 frames in the graph and 69"):
        ground_tracks(graph, {**meshes, "slow": short}, "t")
