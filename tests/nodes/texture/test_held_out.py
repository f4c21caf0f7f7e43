import numpy as np
import pytest

from reperform.nodes.products.footage import Footage, Mattes
from reperform.nodes.texture.held_out import held_out
from reperform.nodes.texture.picture_error import picture_error


def inputs(scene, frame=0):
    return (
        Footage(scene.footage.images[frame], scene.footage.fps),
        Mattes(scene.mattes.alpha[frame], scene.mattes.fps),
        scene.cameras,
        scene.mesh._replace(vertices=scene.mesh.vertices[frame]),
    )


@pytest.mark.parametrize("camera", [0, 3])
def test_the_others_show_what_it_saw(scene, camera):
    footage, mattes, cameras, mesh = inputs(scene)
    film = held_out(footage, mattes, cameras, mesh, camera=camera)
    error = picture_error(film, footage, mattes, camera=camera)
    assert error.psnr > 30
    assert error.ssim > 0.95
    assert error.overlap > 0.995


def test_the_held_out_picture_is_not_used(scene):
    footage, mattes, cameras, mesh = inputs(scene)
    changed = footage.images.copy()
    changed[2] = 255 - changed[2]
    one = held_out(footage, mattes, cameras, mesh, camera=2)
    two = held_out(Footage(changed, footage.fps), mattes, cameras, mesh, camera=2)
    np.testing.assert_array_equal(one.images, two.images)


def test_refuses_a_camera_that_is_not_there(scene):
    with pytest.raises(ValueError, match=r"one of 0 \.\. 5"):
        held_out(*inputs(scene), camera=6)
