import numpy as np
import trimesh

from reperform.nodes.kernels.mesh_geometry import vertex_normals
from reperform.nodes.kernels.surface_pull import fit_target, surface_pull


def _ball(radius):
    ball = trimesh.creation.icosphere(3, radius)
    return ball.vertices * (1, 1.4, 0.8), ball.faces.astype(np.int32)


def test_nothing_pulls_on_the_surface_itself():
    vertices, faces = _ball(0.5)
    target = fit_target(vertices, faces, 0.1)
    pull, force, cost = surface_pull(target.vertices, target.normals, target.share, target, 0.05, 0.1, 0.3)
    np.testing.assert_allclose(force, 0, atol=1e-12)
    assert cost < 1e-8
    assert (np.linalg.eigvalsh(pull) > -1e-12).all()


def test_force_points_towards_the_target_and_cost_is_the_distance():
    vertices, faces = _ball(0.5)
    target = fit_target(vertices, faces, 0.1)
    inner = vertices * 0.98
    normals = vertex_normals(inner, faces)
    _, force, cost = surface_pull(inner, normals, target.share, target, 0.1, 0.1, 0.0)
    assert (np.einsum("vc,vc->v", force, normals) > 0).mean() > 0.99
    gap = np.linalg.norm(vertices - inner, axis=1).mean()
    assert 0.9 * gap < cost < 1.2 * gap


def test_surfaces_that_face_the_other_way_do_not_pull():
    vertices, faces = _ball(0.5)
    target = fit_target(vertices, faces, 0.0)
    pull, force, _ = surface_pull(vertices, -target.normals, target.share, target, 0.1, 0.0, 0.3)
    assert not pull.any()
    assert not force.any()


def test_far_surfaces_do_not_pull():
    vertices, faces = _ball(0.5)
    target = fit_target(vertices, faces, 0.1)
    _, force, cost = surface_pull(vertices + (5.0, 0, 0), target.normals, target.share, target, 0.1, 0.1, 0.3)
    assert not force.any()
    np.testing.assert_allclose(cost, 0.1 * 2**0.5)
