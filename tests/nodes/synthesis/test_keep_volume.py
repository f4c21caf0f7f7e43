from collections.abc import Mapping

import numpy as np
import pytest

from reperform.nodes.kernels.mesh_geometry import volume
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph
from reperform.nodes.synthesis.animate import animate
from reperform.nodes.synthesis.endless import endless
from reperform.nodes.synthesis.keep_volume import keep_volume


def test_every_frame_has_the_volume_of_its_sources(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence]
) -> None:
    played = animate(endless(graph, meshes, seconds=4.0, seed=3), meshes, blend="linear")
    shrunk = played.mesh.vertices.copy()
    shrunk[30:40, :, 0] *= 0.98
    kept = keep_volume(played._replace(mesh=played.mesh._replace(vertices=shrunk)), meshes)
    source, faces = played.provenance, played.mesh.faces
    captured = {name: volume(take.vertices, faces) for name, take in meshes.items()}
    for f in range(len(shrunk)):
        expected = sum(
            source.weight[f, s] * captured[str(source.takes[source.take[f, s]])][source.source_frame[f, s]]
            for s in range(2)
        )
        assert float(volume(kept.mesh.vertices[f], faces)) == pytest.approx(expected, rel=5e-5)
    alone = np.flatnonzero(source.weight[:, 0] == 1.0)
    alone = alone[(alone < 30) | (alone >= 40)]
    np.testing.assert_array_equal(kept.mesh.vertices[alone], played.mesh.vertices[alone])


def test_a_missing_take_is_refused(graph: MotionGraph, meshes: Mapping[str, MeshSequence]) -> None:
    played = animate(endless(graph, meshes, seconds=20.0, seed=5), meshes, blend="linear")
    with pytest.raises(ValueError, match="the motion plays 'turn'"):
        keep_volume(played, {k: v for k, v in meshes.items() if k != "turn"})
