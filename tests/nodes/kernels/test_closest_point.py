import numpy as np
import trimesh

from reperform.nodes.kernels.closest_point import closest_points


def test_regions_of_a_triangle_by_hand():
    vertices = np.array([[0.0, 0, 0], [2, 0, 0], [0, 1, 0]])
    faces = np.array([[0, 1, 2]], np.int32)
    points = np.array([[0.5, 0.25, 3.0], [-1, -1, 0], [3, -1, 0], [1, -2, 0], [-1, 0.5, 1], [2, 1, 0]])
    face, barycentric, distance = closest_points(points, vertices, faces)
    np.testing.assert_array_equal(face, 0)
    np.testing.assert_allclose(barycentric[0], [0.5, 0.25, 0.25])
    np.testing.assert_allclose(barycentric[1], [1, 0, 0])
    np.testing.assert_allclose(barycentric[2], [0, 1, 0])
    np.testing.assert_allclose(barycentric[3], [0.5, 0.5, 0])
    np.testing.assert_allclose(barycentric[4], [0.5, 0, 0.5])
    np.testing.assert_allclose(distance, [3, 2**0.5, 2**0.5, 2, 2**0.5, 2 / 5**0.5], rtol=1e-12)


def test_agrees_with_trying_every_triangle():
    rng = np.random.default_rng(0)
    mesh = trimesh.creation.icosphere(2)
    vertices = mesh.vertices * (0.3, 0.9, 0.2) + (0.4, 1.0, -0.7)
    vertices[0] += (1.5, 0, 0)  # a few triangles much larger than the rest
    points = rng.normal(size=(60, 3)) + (0.4, 1.0, -0.7)
    face, barycentric, distance = closest_points(points, vertices, mesh.faces.astype(np.int32))
    single = [
        closest_points(points, vertices[triangle], np.array([[0, 1, 2]], np.int32))[2]
        for triangle in mesh.faces
    ]
    np.testing.assert_allclose(distance, np.min(single, axis=0), rtol=1e-12)
    found = np.einsum("nk,nkc->nc", barycentric, vertices[mesh.faces[face]])
    np.testing.assert_allclose(np.linalg.norm(found - points, axis=1), distance, rtol=1e-12)
    np.testing.assert_allclose(barycentric.sum(1), 1)
