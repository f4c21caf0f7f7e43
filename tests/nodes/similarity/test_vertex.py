import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import align
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.similarity.vertex import vertex

FACES = np.array([[0, 1, 2], [0, 2, 3]], np.int32)


def _take(seed, frames):
    points = np.random.default_rng(seed).normal(size=(frames, 6, 3)) * (0.3, 0.8, 0.2) + (1, 2, 3)
    return MeshSequence(points.astype(np.float32), FACES, np.float32(25))


def test_is_the_residual_of_laying_one_frame_on_the_other():
    a, b = _take(0, 3), _take(1, 4)
    truth = [[np.sqrt(align(x, y)[1] / 6) for y in b.vertices] for x in a.vertices]
    np.testing.assert_allclose(vertex((a, b)).distance, truth, rtol=1e-5)


def test_without_alignment_it_is_the_plain_distance():
    a, b = _take(2, 2), _take(3, 2)
    plain = np.sqrt(((a.vertices[:, None] - b.vertices[None]) ** 2).sum(axis=(2, 3)) / 6)
    np.testing.assert_allclose(vertex((a, b), align="none").distance, plain, rtol=1e-5)


def test_refuses_other_topology():
    a = _take(0, 2)
    with pytest.raises(ValueError, match=r"similarity\.vertex.*share one topology"):
        vertex((a, a._replace(faces=FACES[:, ::-1].copy())))
