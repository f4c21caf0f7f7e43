from collections.abc import Mapping

import numpy as np
import pytest

from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph
from reperform.nodes.synthesis.endless import endless


def test_it_lasts_as_long_as_asked_and_keeps_to_the_core(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence]
) -> None:
    path = endless(graph, meshes, seconds=300.0, seed=4)
    assert len(path.provenance.take) == 7500
    assert graph.core[path.transition].all()
    assert len(set(path.transition.tolist())) > 0.7 * graph.core.sum()
    np.testing.assert_allclose(path.provenance.weight.sum(axis=1), 1.0)


def test_the_seed_decides(graph: MotionGraph, meshes: Mapping[str, MeshSequence]) -> None:
    one, again, other = (endless(graph, meshes, seconds=20.0, seed=seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one.transition, again.transition)
    assert one.transition.tolist() != other.transition.tolist()


def test_choosiness_makes_it_cheaper(graph: MotionGraph, meshes: Mapping[str, MeshSequence]) -> None:
    costs = [
        float(
            np.asarray(graph.cost)[
                endless(graph, meshes, seconds=200.0, choosiness=c, variety=0.0).transition
            ].mean()
        )
        for c in (0.0, 100.0)
    ]
    assert costs[1] < costs[0]


def test_a_single_take_plays_on(meshes: Mapping[str, MeshSequence], graph: MotionGraph) -> None:
    alone = (np.asarray(graph.source) == 0) & (np.asarray(graph.target) == 0)
    core = alone & (np.asarray(graph.source_frame) > np.asarray(graph.target_frame))
    path = endless(graph._replace(core=core & alone), meshes, seconds=30.0)
    assert set(path.provenance.take.ravel().tolist()) == {0}


def test_a_graph_without_a_loop_is_refused(graph: MotionGraph, meshes: Mapping[str, MeshSequence]) -> None:
    with pytest.raises(ValueError, match="no loop"):
        endless(graph._replace(core=np.zeros_like(graph.core)), meshes)


def test_an_hour_never_dies(graph: MotionGraph, meshes: Mapping[str, MeshSequence]) -> None:
    path = endless(graph, meshes, seconds=3600.0, seed=3)
    assert len(path.provenance.take) == 90_000
    frame, take = np.asarray(path.provenance.source_frame), np.asarray(path.provenance.take)
    whole = np.asarray(path.provenance.weight)[:, 0] == 1.0
    # captured frames of one take play on one by one
    on = whole[1:] & whole[:-1] & (take[1:, 0] == take[:-1, 0])
    assert set(np.diff(frame[:, 0])[on].tolist()) <= {1}
    assert np.isfinite(path.provenance.offset).all()
    assert len(np.unique(path.transition)) >= 0.5 * int(np.asarray(graph.core).sum())
