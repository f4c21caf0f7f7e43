from collections.abc import Mapping

import numpy as np
import pytest

from reperform.nodes.kernels.foot_contacts import foot_contacts
from reperform.nodes.kernels.join_acceleration import join_acceleration_ratio
from reperform.nodes.kernels.path_contacts import path_contacts
from reperform.nodes.motion_graph.surface import surface
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation, MotionGraph
from reperform.nodes.similarity.vertex_velocity import vertex_velocity
from reperform.nodes.studio.perform import perform
from reperform.nodes.synthesis.animate import animate
from reperform.nodes.synthesis.endless import endless
from reperform.nodes.synthesis.hold_contacts import hold_contacts


@pytest.fixture(scope="module")
def takes() -> Mapping[str, MeshSequence]:
    return {
        "walk": perform(motion="walk", seconds=1.6, heading=0.4).mesh,
        "turn": perform(motion="turn_left", seconds=1.6, phase=0.3).mesh,
    }


@pytest.fixture(scope="module")
def played(takes: Mapping[str, MeshSequence]) -> Animation:
    similarity = {(a, b): vertex_velocity((takes[a], takes[b])) for a in takes for b in takes}
    graph = surface(similarity, takes)
    return animate(endless(graph, takes, seconds=5.0, seed=2), takes)


def test_resting_feet_stand_still_and_nothing_else_changes_much(
    takes: Mapping[str, MeshSequence], played: Animation
) -> None:
    held = hold_contacts(played, takes)
    found = foot_contacts([m.vertices for m in takes.values()], played.mesh.faces, 25.0)
    origin = played.provenance
    order = np.array([list(takes).index(str(take)) for take in origin.takes])
    planted = path_contacts(order[origin.take], origin.source_frame, origin.weight, found.planted)

    def slide(animation: Animation) -> float:
        steps = []
        for k in range(2):
            sole = animation.mesh.vertices[:, found.foot == k].mean(axis=1, dtype=float)
            steps.append(np.linalg.norm(np.diff(sole, axis=0), axis=1)[planted[1:, k] & planted[:-1, k]])
        return float(np.concatenate(steps).max()) * 25

    assert slide(played) > 0.1
    assert slide(held) < 0.001
    high = played.mesh.vertices[..., 1] > 1.05
    np.testing.assert_array_equal(held.mesh.vertices[high], played.mesh.vertices[high])
    captured = [m.vertices for m in takes.values()]
    ratios = [join_acceleration_ratio(a.mesh.vertices, origin.weight, captured, 25.0) for a in (played, held)]
    assert ratios[1] < ratios[0] + 0.05


def test_what_has_no_feet_comes_back_unchanged(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence]
) -> None:
    played = animate(endless(graph, meshes, seconds=2.0, seed=3), meshes)
    held = hold_contacts(played, meshes, speed=0.01)
    np.testing.assert_array_equal(held.mesh.vertices, played.mesh.vertices)


def test_a_missing_take_and_another_topology_are_refused(
    takes: Mapping[str, MeshSequence], played: Animation
) -> None:
    with pytest.raises(ValueError, match="the motion plays 'turn'"):
        hold_contacts(played, {"walk": takes["walk"]})
    other = takes["turn"]._replace(faces=takes["turn"].faces[::-1])
    with pytest.raises(ValueError, match="topology of the motion"):
        hold_contacts(played, {**takes, "turn": other})
