import numpy as np
import pytest

from reperform.nodes.blend.linear import linear
from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.products.mesh import MeshSequence


def _take(frames: int, seed: int) -> MeshSequence:
    random = np.random.default_rng(seed)
    vertices = random.normal(size=(1, 12, 3)) + np.cumsum(random.normal(size=(frames, 1, 3)) * 0.01, axis=0)
    return MeshSequence(
        vertices.astype(np.float32), np.array([[0, 1, 2], [1, 3, 2]], np.int32), np.asarray(25.0, np.float32)
    )


def test_both_ends_are_the_takes_to_the_bit() -> None:
    takes = _take(9, 0), _take(14, 1)
    np.testing.assert_array_equal(linear(takes, weight=0.0, place=False).vertices, takes[0].vertices)
    np.testing.assert_array_equal(linear(takes, weight=1.0, place=False).vertices, takes[1].vertices)


def test_stretched_takes_meet_at_both_ends_of_time() -> None:
    takes = _take(9, 0), _take(15, 1)
    blend = linear(takes, weight=0.25, place=False).vertices
    assert len(blend) == round(0.75 * 9 + 0.25 * 15)
    for k in (0, -1):
        np.testing.assert_allclose(
            blend[k], 0.75 * takes[0].vertices[k] + 0.25 * takes[1].vertices[k], atol=1e-6
        )
    assert len(linear(takes, weight=0.25, pace="frame by frame").vertices) == 9


def test_the_same_motion_elsewhere_blends_to_itself() -> None:
    take = _take(10, 3)
    moved = take._replace(vertices=apply(take.vertices, Placement(1.2, np.array([3.0, -1.0]))))
    np.testing.assert_allclose(linear((take, moved), weight=0.5).vertices, take.vertices, atol=1e-5)


def test_different_topology_or_rate_is_refused() -> None:
    a, b = _take(5, 0), _take(5, 1)
    with pytest.raises(ValueError, match="one topology"):
        linear((a, b._replace(faces=b.faces[::-1])))
    with pytest.raises(ValueError, match="one frame rate"):
        linear((a, b._replace(fps=np.asarray(50.0, np.float32))))
