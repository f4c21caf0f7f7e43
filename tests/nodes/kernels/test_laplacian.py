import numpy as np
import pytest
import scipy.sparse
import trimesh

from reperform.nodes.kernels import laplacian, mesh_geometry
from reperform.nodes.kernels.rotation import exp


@pytest.fixture
def mesh() -> tuple[np.ndarray, np.ndarray]:
    blob = trimesh.creation.icosphere(subdivisions=2)
    vertices = np.asarray(blob.vertices) * [0.3, 0.9, 0.2] + [1.0, 0.4, -2.0]
    return vertices + 0.02 * np.sin(9 * vertices[:, [1, 2, 0]]), np.asarray(blob.faces, np.int32)


def test_the_cotangent_laplacian_is_the_gradients_square(mesh: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, faces = mesh
    gradient = laplacian.gradient_operator(vertices, faces)
    areas = scipy.sparse.diags(np.repeat(mesh_geometry.face_areas(vertices, faces), 3))
    gap = gradient.T @ areas @ gradient - laplacian.cotangent_laplacian(vertices, faces)
    assert abs(gap).max() < 1e-12


def test_gradients_of_a_linear_function_are_its_slope_along_the_faces(
    mesh: tuple[np.ndarray, np.ndarray],
) -> None:
    vertices, faces = mesh
    slope = np.array([0.3, -2.0, 1.1])
    gradients = (laplacian.gradient_operator(vertices, faces) @ (vertices @ slope)).reshape(-1, 3)
    normals = mesh_geometry.face_normals(vertices, faces)
    np.testing.assert_allclose(gradients, slope - normals * (normals @ slope)[:, None], atol=1e-11)


def test_the_uniform_laplacian_counts_neighbours() -> None:
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    expected = [[3, -1, -1, -1, 0], [-1, 2, -1, 0, 0], [-1, -1, 3, -1, 0], [-1, 0, -1, 2, 0], [0, 0, 0, 0, 0]]
    np.testing.assert_array_equal(laplacian.uniform_laplacian(faces, 5).toarray(), expected)


def test_deformation_gradients_of_a_rigid_motion_are_its_rotation(
    mesh: tuple[np.ndarray, np.ndarray],
) -> None:
    vertices, faces = mesh
    turn = exp(np.array([0.4, -1.0, 0.3]))
    found = laplacian.deformation_gradients(vertices, vertices @ turn.T + [1.0, 2.0, 3.0], faces)
    np.testing.assert_allclose(found, np.broadcast_to(turn, found.shape), atol=1e-10)


def test_a_factored_matrix_solves(mesh: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, faces = mesh
    matrix = laplacian.cotangent_laplacian(vertices, faces) + 0.01 * scipy.sparse.eye(len(vertices))
    truth = np.random.default_rng(1).normal(size=(len(vertices), 3))
    np.testing.assert_allclose(laplacian.factorise(matrix).solve(matrix @ truth), truth, atol=1e-9)
