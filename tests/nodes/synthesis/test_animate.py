from collections.abc import Mapping

import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph
from reperform.nodes.synthesis.animate import animate
from reperform.nodes.synthesis.endless import endless


@pytest.mark.parametrize("blend", ["linear", "nonlinear"])
def test_captured_frames_are_played_as_captured(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence], blend: str
) -> None:
    path = endless(graph, meshes, seconds=8.0, seed=3)
    played = animate(path, meshes, blend=blend)
    source = played.provenance
    for f in np.flatnonzero(source.weight[:, 0] == 1.0):
        captured = meshes[source.takes[source.take[f, 0]]].vertices[source.source_frame[f, 0]]
        placed = apply(captured, Placement(source.yaw[f, 0], source.offset[f, 0]))
        np.testing.assert_array_equal(played.mesh.vertices[f], placed)


def test_joins_are_as_smooth_as_the_capture(graph: MotionGraph, meshes: Mapping[str, MeshSequence]) -> None:
    played = animate(endless(graph, meshes, seconds=20.0, seed=5), meshes).mesh.vertices.astype(float)
    captured = np.concatenate([np.diff(m.vertices.astype(float), axis=0) for m in meshes.values()])
    fastest = np.linalg.norm(captured, axis=2).max()
    steps = np.linalg.norm(np.diff(played, axis=0), axis=2)
    assert steps.max() < 1.3 * fastest


def test_the_height_is_kept_and_the_bodies_stand_upright(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence]
) -> None:
    played = animate(endless(graph, meshes, seconds=20.0, seed=6), meshes).mesh.vertices
    captured = np.concatenate([m.vertices for m in meshes.values()])
    assert played[..., 1].min() > captured[..., 1].min() - 0.02
    assert played[..., 1].max() < captured[..., 1].max() + 0.02


def test_a_missing_take_and_another_topology_are_refused(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence]
) -> None:
    path = endless(graph, meshes, seconds=20.0, seed=5)
    with pytest.raises(ValueError, match="the path plays 'turn'"):
        animate(path, {k: v for k, v in meshes.items() if k != "turn"})
    other = meshes["turn"]._replace(faces=meshes["turn"].faces[::-1])
    with pytest.raises(ValueError, match="share one topology"):
        animate(path, {**meshes, "turn": other})
