import numpy as np
import trimesh

from reperform.nodes.kernels.camera import look_at
from reperform.nodes.kernels.source_view import source_view
from reperform.nodes.kernels.vertex_colour import vertex_colour


def half_seen(colour):
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=0.4)
    vertices = mesh.vertices * (1, 0.7, 1.3) + (0.1, 0, -0.2)
    pose = look_at(np.array([0.3, 0.2, 2.5]), np.zeros(3))
    camera = (np.array([[250.0, 0, 100], [0, 250, 80], [0, 0, 1]]), *pose, np.zeros(5))
    image = np.broadcast_to(np.asarray(colour, np.uint8), (160, 200, 3)).copy()
    view = source_view(image, np.full((160, 200), 255, np.uint8), vertices, mesh.faces, camera)
    return vertices, mesh, view


def test_what_no_camera_sees_takes_the_colour_beside_it():
    vertices, mesh, view = half_seen((180, 90, 30))
    colour = vertex_colour(vertices, mesh.faces, mesh.vertex_normals, [view])
    np.testing.assert_allclose(colour, np.broadcast_to((180, 90, 30), colour.shape), atol=0.01)


def test_a_separate_piece_takes_the_mean_and_nothing_seen_is_grey():
    vertices, mesh, view = half_seen((180, 90, 30))
    apart = np.concatenate([vertices, vertices * 0.1 - (0, 0, 9)])
    faces = np.concatenate([mesh.faces, mesh.faces + len(vertices)])
    normals = np.concatenate([mesh.vertex_normals] * 2)
    colour = vertex_colour(apart, faces, normals, [view])
    np.testing.assert_allclose(
        colour[len(vertices) :], np.broadcast_to((180, 90, 30), vertices.shape), atol=0.5
    )
    assert (vertex_colour(vertices, mesh.faces, mesh.vertex_normals, []) == 128).all()
