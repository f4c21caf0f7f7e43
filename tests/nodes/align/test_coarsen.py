import numpy as np
import pytest
import trimesh

from reperform.nodes.align.coarsen import coarsen
from reperform.nodes.kernels.decimate import is_closed
from reperform.nodes.kernels.rotation import exp
from reperform.nodes.products.mesh import MeshSequence


@pytest.fixture
def takes():
    ball = trimesh.creation.icosphere(subdivisions=3)
    base = np.asarray(ball.vertices) * [0.3, 0.8, 0.2]
    faces, fps = np.asarray(ball.faces, np.int32), np.asarray(25.0, np.float32)
    turn = exp(np.array([0.3, 0.9, -0.2]))
    first = MeshSequence(np.array([base, base * 1.1], np.float32), faces, fps)
    return {
        "a": first,
        "b": MeshSequence((first.vertices @ turn.T + [1, 2, 3]).astype(np.float32), faces, fps),
    }, turn


def test_all_takes_share_one_closed_topology(takes):
    meshes, turn = takes
    coarse = coarsen(meshes, vertices=200)
    np.testing.assert_array_equal(coarse["a"].faces, coarse["b"].faces)
    assert is_closed(coarse["a"].faces) and coarse["a"].vertices.shape[1] <= 200
    # bound to the surface, so moving and coarsening commute
    np.testing.assert_allclose(coarse["b"].vertices, coarse["a"].vertices @ turn.T + [1, 2, 3], atol=1e-5)
    radius = np.linalg.norm(coarse["a"].vertices[0] / [0.3, 0.8, 0.2], axis=1)
    assert radius.min() > 0.93 and radius.max() < 1.001


def test_small_meshes_stay_as_they_are(takes):
    meshes, _ = takes
    coarse = coarsen(meshes, vertices=5000)
    np.testing.assert_array_equal(coarse["b"].vertices, meshes["b"].vertices)
    np.testing.assert_array_equal(coarse["a"].faces, meshes["a"].faces)


def test_open_meshes_and_other_topologies_are_refused(takes):
    meshes, _ = takes
    opened = {name: take._replace(faces=take.faces[:-1]) for name, take in meshes.items()}
    with pytest.raises(ValueError, match="must be closed"):
        coarsen(opened, vertices=200)
    with pytest.raises(ValueError, match="b differs from a"):
        coarsen({**meshes, "b": meshes["b"]._replace(faces=meshes["b"].faces[::-1])})
