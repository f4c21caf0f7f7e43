import numpy as np
import pytest

from reperform.nodes.kernels.decimate import is_closed
from reperform.nodes.kernels.edge_split import split_long_edges
from reperform.nodes.kernels.mesh_geometry import face_areas, volume

VERTICES = np.array([[0, 0, 0], [1.3, 0.1, 0], [0.2, 0.9, 0.1], [0.3, 0.2, 0.4]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], np.int32)


@pytest.mark.parametrize("longest", [1.0, 0.5, 0.17])
def test_the_surface_is_the_same_with_shorter_edges(longest: float) -> None:
    points, faces = split_long_edges(VERTICES, FACES, longest)
    corners = points[faces]
    assert np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2).max() <= longest
    assert is_closed(faces)
    assert np.array_equal(points[:4], VERTICES)
    assert volume(points, faces) == pytest.approx(volume(VERTICES, FACES))
    assert face_areas(points, faces).sum() == pytest.approx(face_areas(VERTICES, FACES).sum())


def test_short_edges_stay() -> None:
    points, faces = split_long_edges(VERTICES, FACES, 2.0)
    assert np.array_equal(points, VERTICES)
    assert np.array_equal(faces, FACES)
