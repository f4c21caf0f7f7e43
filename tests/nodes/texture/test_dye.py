import numpy as np

from reperform.nodes.products.mesh import TextureAtlas
from reperform.nodes.texture.dye import dye


def _atlas():
    image = np.random.default_rng(0).integers(0, 256, (9, 7, 3)).astype(np.uint8)
    return TextureAtlas(np.zeros((3, 2), np.float32), np.array([[0, 1, 2]], np.int32), image)


def test_a_third_of_the_circle_moves_red_to_green():
    atlas = _atlas()
    np.testing.assert_allclose(dye(atlas, hue=120.0).image[..., [1, 2, 0]].astype(int), atlas.image, atol=1)


def test_nothing_asked_nothing_changed_and_brightness_scales():
    atlas = _atlas()
    assert dye(atlas, hue=360.0).image is atlas.image
    np.testing.assert_allclose(dye(atlas, value=0.5).image.astype(int), atlas.image / 2, atol=1)
