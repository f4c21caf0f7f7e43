import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels import mesh_geometry


@pytest.fixture
def ellipsoid() -> trimesh.Trimesh:
    mesh = trimesh.creation.icosphere(subdivisions=3)
    mesh.vertices = mesh.vertices * [0.3, 0.9, 0.2] + [1.0, 0.4, -2.0]
    return mesh


def test_figures_agree_with_trimesh(ellipsoid: trimesh.Trimesh) -> None:
    vertices, faces = np.asarray(ellipsoid.vertices), np.asarray(ellipsoid.faces)
    np.testing.assert_allclose(mesh_geometry.face_areas(vertices, faces), ellipsoid.area_faces)
    np.testing.assert_allclose(mesh_geometry.face_normals(vertices, faces), ellipsoid.face_normals, atol=1e-9)
    assert mesh_geometry.volume(vertices, faces) == pytest.approx(ellipsoid.volume)
    np.testing.assert_allclose(
        mesh_geometry.centroid(vertices, faces),
        ellipsoid.triangles_center.T @ ellipsoid.area_faces / ellipsoid.area,
    )
    np.testing.assert_array_equal(mesh_geometry.edges(faces), np.unique(ellipsoid.edges_unique, axis=0))
    assert mesh_geometry.vertex_areas(vertices, faces).sum() == pytest.approx(ellipsoid.area)


def test_frames_are_carried_through(ellipsoid: trimesh.Trimesh) -> None:
    vertices = np.stack([ellipsoid.vertices, np.asarray(ellipsoid.vertices) * 2.0]).astype(np.float32)
    faces = np.asarray(ellipsoid.faces)
    assert mesh_geometry.vertex_normals(vertices, faces).dtype == np.float32
    np.testing.assert_allclose(
        mesh_geometry.vertex_normals(vertices, faces)[1],
        mesh_geometry.vertex_normals(vertices[0], faces),
        atol=1e-5,
    )
    volumes = mesh_geometry.volume(vertices, faces)
    assert volumes[1] == pytest.approx(8.0 * volumes[0], rel=1e-5)
    np.testing.assert_allclose(mesh_geometry.centroid(vertices, faces)[0], [1.0, 0.4, -2.0], atol=1e-3)


def test_vertex_normals_point_out(ellipsoid: trimesh.Trimesh) -> None:
    vertices = np.asarray(ellipsoid.vertices)
    outward = (vertices - [1.0, 0.4, -2.0]) / np.square([0.3, 0.9, 0.2])
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    normals = mesh_geometry.vertex_normals(vertices, np.asarray(ellipsoid.faces))
    assert np.einsum("vk,vk->v", normals, outward).min() > 0.97


def test_a_loose_vertex_and_a_flat_face_have_no_normal() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [5, 5, 5]])
    faces = np.array([[0, 1, 2]])
    assert not mesh_geometry.face_normals(vertices, faces).any()
    assert not mesh_geometry.vertex_normals(vertices, faces).any()
