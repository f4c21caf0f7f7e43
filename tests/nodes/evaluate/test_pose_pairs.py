import numpy as np
import pytest
import trimesh

from reperform.nodes.evaluate.pose_pairs import pose_pairs
from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.products.mesh import MeshSequence


@pytest.fixture
def takes():
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.4)
    base = np.asarray(ball.vertices) * [1.0, 1.6, 0.7] + [0.2, 1.0, -0.1]
    rise = np.array([0.0, 0.1, 0.3, 0.2, 0.05])
    first = np.array([base * [1, 1 + 0.1 * k, 1] + [0, up, 0] for k, up in enumerate(rise)], np.float32)
    moved = apply(first, Placement(0.8, np.array([2.0, -1.0])))
    faces, fps = np.asarray(ball.faces, np.int32), np.asarray(25.0, np.float32)
    return {"a": MeshSequence(first, faces, fps), "b": MeshSequence(moved, faces, fps)}


def test_the_same_pose_elsewhere_is_laid_on_the_first(takes):
    pairs = pose_pairs(takes, pairs=("same a:2 b:2", "top a:highest b:highest a:lowest", "like a:3 b:like"))
    assert pairs.name.tolist() == ["same", "top", "like"]
    for k in range(3):
        np.testing.assert_allclose(pairs.second[k], pairs.first[k], atol=1e-5)
    np.testing.assert_allclose(pairs.middle[1], takes["a"].vertices[0], atol=1e-6)
    assert np.isnan(pairs.middle[[0, 2]]).all()


def test_fewer_vertices_stay_on_the_surface_in_all_poses(takes):
    pairs = pose_pairs(takes, pairs=("same a:0 b:4",), vertices=200)
    assert pairs.first.shape[1] <= 200 and pairs.faces.max() == pairs.first.shape[1] - 1
    inner = (pairs.first[0] - [0.2, 1.0, -0.1]) / [0.4, 0.64, 0.28]
    assert np.linalg.norm(inner, axis=1).min() > 0.93 and np.linalg.norm(inner, axis=1).max() < 1.001


def test_what_cannot_be_read_is_refused(takes):
    for pairs, message in (
        (("x a:0",), "NAME FIRST SECOND"),
        (("x a:0 c:0",), "no take 'c'; there are a, b"),
        (("x a:0 b:9",), r"FRAME in 0 \.\. 4"),
        (("x a:like b:0",), "not for the first"),
    ):
        with pytest.raises(ValueError, match=message):
            pose_pairs(takes, pairs=pairs)
    takes["b"] = takes["b"]._replace(faces=takes["b"].faces[::-1])
    with pytest.raises(ValueError, match="b differs: align"):
        pose_pairs(takes, pairs=("x a:0 b:0",))
