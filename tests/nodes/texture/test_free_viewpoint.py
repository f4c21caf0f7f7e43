import numpy as np
import pytest

from reperform.nodes.kernels.picture_error import psnr
from reperform.nodes.products.cameras import CameraPath
from reperform.nodes.products.footage import Footage, Mattes
from reperform.nodes.products.mesh import MeshSequence, Surfaces
from reperform.nodes.texture.free_viewpoint import free_viewpoint
from reperform.nodes.texture.orbit import circle


def first(scene):
    return (
        Footage(scene.footage.images[0], scene.footage.fps),
        Mattes(scene.mattes.alpha[0], scene.mattes.fps),
        scene.cameras,
    )


def camera(angle: float = 37, size: tuple[int, int] = (260, 240)) -> CameraPath:
    middle = np.array([[0.3, 0.85, -0.2]])
    path = circle(middle, np.radians([angle]), radius=2.4, height=1.3, field_of_view=50, size=size)
    return CameraPath(path.matrix[0], path.rotation[0], path.translation[0], path.image_size)


def frame(scene) -> MeshSequence:
    return scene.mesh._replace(vertices=scene.mesh.vertices[0])


@pytest.mark.parametrize("angle", [37, 100, 220])
def test_between_the_cameras_it_is_near_the_truth(scene, angle):
    view = camera(angle)
    film = free_viewpoint(*first(scene), view, frame(scene))
    truth, alpha = scene.truth(
        scene.mesh.vertices[0], (view.matrix, view.rotation, view.translation), 240, 260, (0, 0, 0)
    )
    np.testing.assert_array_equal(film.coverage, alpha)
    assert psnr(film.images, truth, alpha == 255) > 33
    # no green of the screen comes in: green never leads in the paint
    inside = film.images[film.coverage == 255].astype(int)
    assert (inside[:, 1] - inside[:, [0, 2]].max(axis=1)).max() < 5


def test_from_a_cameras_own_place_it_is_that_cameras_picture(scene):
    view = CameraPath(
        scene.cameras.matrix[2], scene.cameras.rotation[2], scene.cameras.translation[2], np.int32([300, 260])
    )
    film = free_viewpoint(*first(scene), view, frame(scene))
    truth, alpha = scene.truth(
        scene.mesh.vertices[0], (view.matrix, view.rotation, view.translation), 260, 300, (0, 0, 0)
    )
    assert psnr(film.images, truth, alpha == 255) > 36


def test_surfaces_do_as_well_as_a_mesh(scene):
    mesh = frame(scene)
    one = free_viewpoint(*first(scene), camera(), mesh)
    two = free_viewpoint(*first(scene), camera(), None, Surfaces(mesh.vertices, mesh.faces, mesh.fps))
    np.testing.assert_array_equal(one.images, two.images)


def test_a_hole_takes_the_colour_around_it(scene):
    """Two cameras on one side: the other side is filled with the performer's colours, not black or green."""
    footage, mattes, cameras = first(scene)
    pick = [0, 1]
    few = type(cameras)(*(field[pick] for field in cameras))
    film = free_viewpoint(
        Footage(footage.images[pick], footage.fps),
        Mattes(mattes.alpha[pick], mattes.fps),
        few,
        camera(220),
        frame(scene),
    )
    inside = film.images[film.coverage == 255].astype(int)
    assert inside[:, 0].min() > 50
    assert (inside[:, 1] - inside[:, [0, 2]].max(axis=1)).max() < 5


def test_an_empty_stage_is_a_picture_too(scene):
    away = camera()._replace(translation=np.array([0.0, 0, -50.0]))
    film = free_viewpoint(*first(scene), away, frame(scene))
    assert (film.coverage == 0).all()
    assert film.images.std() < 60


def test_refuses_other_views(scene):
    footage, mattes, cameras = first(scene)
    with pytest.raises(ValueError, match="must show the same views"):
        free_viewpoint(footage, Mattes(mattes.alpha[1:], mattes.fps), cameras, camera(), frame(scene))
