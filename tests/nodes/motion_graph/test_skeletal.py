from collections.abc import Mapping

import numpy as np
import pytest

from reperform.nodes.motion_graph.skeletal import skeletal
from reperform.nodes.motion_graph.surface import surface
from reperform.nodes.products.mocap import Mocap
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.similarity.vertex_velocity import vertex_velocity
from reperform.nodes.skeleton.bones import bones


@pytest.fixture(scope="module")
def similarity(striders: Mapping[str, Mocap]) -> dict[tuple[str, str], Dissimilarity]:
    points = {name: bones(take.skeleton) for name, take in striders.items()}
    return {(a, b): vertex_velocity((points[a], points[b])) for a in points for b in points}


def test_takes_flow_into_each_other_where_the_step_cycle_agrees(
    striders: Mapping[str, Mocap], similarity: dict[tuple[str, str], Dissimilarity]
) -> None:
    graph = skeletal(similarity, {name: take.skeleton for name, take in striders.items()})
    assert graph.core.sum() >= 6
    phases = np.array([0.0, 5.0, 9.0])
    gap = (graph.source_frame + phases[graph.source] - graph.target_frame - phases[graph.target]) % 24
    assert (np.minimum(gap, 24 - gap) <= 3).all()


def test_it_is_the_surface_graph_of_the_joints(
    striders: Mapping[str, Mocap], similarity: dict[tuple[str, str], Dissimilarity]
) -> None:
    skeletons = {name: take.skeleton for name, take in striders.items()}
    one = skeletal(similarity, skeletons, transitions=2, forbid=("slow:0-20",))
    other = surface(
        similarity, {k: bones(s) for k, s in skeletons.items()}, transitions=2, forbid=("slow:0-20",)
    )
    for a, b in zip(one, other, strict=True):
        np.testing.assert_array_equal(a, b)


def test_other_hierarchies_are_refused_by_its_own_name(
    striders: Mapping[str, Mocap], similarity: dict[tuple[str, str], Dissimilarity]
) -> None:
    skeletons = {name: take.skeleton for name, take in striders.items()}
    parents = skeletons["slow"].parents.copy()
    parents[9] = 1
    with pytest.raises(ValueError, match=r"motion_graph\.skeletal: takes must share one topology"):
        skeletal(similarity, {**skeletons, "slow": skeletons["slow"]._replace(parents=parents)})
