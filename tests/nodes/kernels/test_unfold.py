import numpy as np
import trimesh

from reperform.nodes.kernels.laplacian import vertex_adjacency
from reperform.nodes.kernels.mesh_geometry import face_normals
from reperform.nodes.kernels.unfold import unfold


def test_a_pushed_in_vertex_comes_back_and_the_rest_stays() -> None:
    ball = trimesh.creation.icosphere(subdivisions=3)
    points, faces = np.asarray(ball.vertices) * [0.3, 0.5, 0.2], np.asarray(ball.faces, np.int32)
    adjacency = vertex_adjacency(faces, len(points))
    assert np.array_equal(unfold(points, faces, adjacency), points)
    bad = points.copy()
    start, end = adjacency[100].indices[:2]
    bad[100] = points[100] + 2.5 * (points[start] - points[100]) + 0.7 * (points[end] - points[100])
    outward = lambda p: ((face_normals(p, faces) * p[faces[:, 0]]).sum(axis=1) > 0).all()  # noqa: E731
    assert not outward(bad)
    mended = unfold(bad, faces, adjacency)
    assert outward(mended)
    assert (np.abs(mended - bad).max(axis=1) > 0).sum() < 40
