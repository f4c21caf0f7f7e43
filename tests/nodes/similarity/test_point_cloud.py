import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import align
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.performance import SkeletonSequence
from reperform.nodes.similarity.point_cloud import point_cloud
from reperform.nodes.similarity.vertex import vertex

FACES = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
NAMES = np.array(["hips", "head", "hand", "foot"])


def _points(seed, frames):
    return (np.random.default_rng(seed).normal(size=(frames, 4, 3)) * (0.3, 0.8, 0.2) + (2, 1, 0)).astype(
        np.float32
    )


def _mesh(seed, frames):
    return MeshSequence(_points(seed, frames), FACES, np.float32(25))


def _skeleton(seed, frames):
    return SkeletonSequence(_points(seed, frames), np.array([-1, 0, 0, 0], np.int32), NAMES, np.float32(25))


@pytest.mark.parametrize(("i", "j"), [(3, 4), (0, 2), (6, 0)])
def test_is_the_residual_of_laying_one_window_on_the_other(i, j):
    a, b = _skeleton(0, 7), _skeleton(1, 6)
    distance = point_cloud(skeleton=(a, b), window=0.16, weights={"head": 2.0}).distance
    steps = [k for k in (-2, -1, 0, 1, 2) if 0 <= i + k < 7 and 0 <= j + k < 6]
    weight = np.concatenate([(1 - abs(k) / 3) * np.array([1, 2, 1, 1]) for k in steps])
    cloud, other = (np.concatenate([take.joints[at + k] for k in steps]) for take, at in ((a, i), (b, j)))
    np.testing.assert_allclose(
        distance[i, j], np.sqrt(align(cloud, other, weight)[1] / weight.sum()), rtol=1e-5
    )


def test_a_window_of_one_frame_is_the_vertex_distance():
    a, b = _mesh(2, 5), _mesh(3, 4)
    np.testing.assert_allclose(point_cloud((a, b), window=0.0).distance, vertex((a, b)).distance, rtol=1e-5)


def test_tells_opposite_motions_through_one_pose_apart():
    a = _mesh(4, 5)
    back = a._replace(vertices=a.vertices[::-1].copy())
    assert vertex((a, back)).distance[2, 2] < 1e-5
    assert point_cloud((a, back)).distance[2, 2] > 0.1


def test_wants_one_kind_of_points():
    a, s = _mesh(0, 3), _skeleton(0, 3)
    with pytest.raises(ValueError, match="got neither"):
        point_cloud()
    with pytest.raises(ValueError, match="got both"):
        point_cloud((a, a), (s, s))
    with pytest.raises(ValueError, match="same joints"):
        point_cloud(skeleton=(s, s._replace(names=NAMES[::-1])))
    with pytest.raises(ValueError, match="one topology"):
        point_cloud((a, a._replace(faces=FACES[:, ::-1].copy())))
