import numpy as np
import pytest

from reperform.nodes.kernels.camera import project
from reperform.nodes.products.cameras import CameraPath
from reperform.nodes.products.mesh import Surfaces
from reperform.nodes.products.vertex_colours import VertexColours
from reperform.nodes.texture.orbit import circle
from reperform.nodes.texture.shade import shade


def camera() -> CameraPath:
    path = circle(
        np.array([[0.3, 0.85, -0.2]]),
        np.radians([20]),
        radius=3,
        height=1.3,
        field_of_view=45,
        size=(220, 240),
    )
    return CameraPath(path.matrix[0], path.rotation[0], path.translation[0], path.image_size)


def test_lit_from_above_with_a_shadow_on_the_floor(scene):
    mesh = scene.mesh._replace(vertices=scene.mesh.vertices[0])
    view = camera()
    film = shade(view, mesh)
    grey = film.images.mean(axis=-1)
    inside = film.coverage == 255
    rows = np.nonzero(inside)[0]
    top, bottom = np.percentile(rows, [10, 90])
    assert (
        grey[: int(top)][inside[: int(top)]].mean() > 1.15 * grey[int(bottom) :][inside[int(bottom) :]].mean()
    )
    bare = shade(view, mesh, shadow=0.0)
    darker = (bare.images.mean(axis=-1) - grey > 8) & (film.coverage == 0)
    assert darker.sum() > 300
    # the darkest spot of the floor is near where the light's ray through the performer meets it
    pixel, _ = project(np.array([[0.55, 0.0, -0.4]]), view.matrix, view.rotation, view.translation)
    assert darker[int(pixel[0, 1]), int(pixel[0, 0])]


def test_vertex_colours_stay_on_the_surface(scene):
    mesh = scene.mesh._replace(vertices=scene.mesh.vertices[0])
    colours = np.zeros((len(mesh.vertices), 3), np.uint8)
    colours[:2562, 0] = 200
    colours[2562:, 2] = 200
    film = shade(camera(), mesh, None, VertexColours(colours))
    inside = film.images[film.coverage == 255].astype(int)
    body, arm = inside[:, 0] > 40, inside[:, 2] > 40
    assert (body ^ arm).all()
    assert arm.sum() > 100
    surfaces = Surfaces(mesh.vertices, mesh.faces, mesh.fps)
    np.testing.assert_array_equal(film.images, shade(camera(), None, surfaces, VertexColours(colours)).images)


def test_refusals(scene):
    mesh = scene.mesh._replace(vertices=scene.mesh.vertices[0])
    with pytest.raises(ValueError, match="colour must be red, green, blue"):
        shade(camera(), mesh, colour=[0.5])
    with pytest.raises(ValueError, match="colours must be of the 3204 vertices, got 4"):
        shade(camera(), mesh, None, VertexColours(np.zeros((4, 3), np.uint8)))
