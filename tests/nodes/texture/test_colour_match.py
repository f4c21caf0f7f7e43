import numpy as np
import pytest

from reperform.nodes.products.footage import Footage, Mattes
from reperform.nodes.products.mesh import Surfaces
from reperform.nodes.ragged import Ragged
from reperform.nodes.texture.colour_match import colour_match
from reperform.nodes.texture.held_out import held_out
from reperform.nodes.texture.picture_error import picture_error

CAST = np.array([0.75, 1.0, 1.2])


def cast(scene, camera: int) -> Footage:
    images = scene.footage.images.copy()
    images[:, camera] = np.rint(np.minimum(images[:, camera] * CAST, 255))
    return scene.footage._replace(images=images)


def test_a_colour_cast_is_found(scene):
    found = colour_match(cast(scene, 4), scene.mattes, scene.cameras, scene.mesh).gain
    np.testing.assert_allclose(found[4], 1 / CAST, rtol=0.03)
    np.testing.assert_allclose(np.delete(found, 4, 0), 1, rtol=0.03)


def test_surfaces_give_the_same(scene):
    mesh = scene.mesh
    surfaces = Surfaces(Ragged(list(mesh.vertices)), Ragged([mesh.faces] * 2), mesh.fps)
    one = colour_match(scene.footage, scene.mattes, scene.cameras, mesh)
    two = colour_match(scene.footage, scene.mattes, scene.cameras, None, surfaces)
    np.testing.assert_array_equal(one.gain, two.gain)


@pytest.mark.parametrize("camera", [3, 4])
def test_matching_undoes_the_cast_in_a_held_out_view(scene, camera):
    footage = cast(scene, 4)
    match = colour_match(footage, scene.mattes, scene.cameras, scene.mesh)
    frame, matte = Footage(footage.images[0], footage.fps), Mattes(scene.mattes.alpha[0], scene.mattes.fps)
    mesh = scene.mesh._replace(vertices=scene.mesh.vertices[0])
    plain, matched = (
        picture_error(
            held_out(frame, matte, scene.cameras, mesh, None, colours, camera=camera),
            frame,
            matte,
            camera=camera,
        )
        for colours in (None, match)
    )
    assert matched.psnr > 29
    assert matched.psnr > plain.psnr + 4
