import numpy as np
import pytest

from reperform.nodes.products.mesh import MeshSequence, TextureAtlas
from reperform.nodes.studio.film import BACKDROPS, film
from reperform.nodes.studio.rig import rig
from reperform.nodes.studio.true_mattes import true_mattes

CAMERAS = rig(width=320, picture_height=200, stage_radius=0.8)


def camera(index: int):
    return type(CAMERAS)(*(field[index] for field in CAMERAS))


@pytest.fixture(scope="module")
def block():
    """A slanted box with three coloured sides, off the origin."""
    corners = np.array([[x, y, z] for x in (0, 0.5) for y in (0.05, 1.4) for z in (0, 0.3)], np.float32)
    corners += corners[:, 1:2] * np.array([0.15, 0, -0.1], np.float32)
    faces = np.array(
        [
            [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
            [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
        ],
        np.int32,
    )  # fmt: skip
    image = np.zeros((4, 12, 3), np.uint8)
    image[:, :4], image[:, 4:8], image[:, 8:] = (200, 60, 40), (220, 210, 60), (60, 60, 60)
    uv = np.array([[1 / 6, 0.5], [0.5, 0.5], [5 / 6, 0.5]], np.float32)
    faces_uv = np.repeat(np.arange(12) // 4, 3).reshape(12, 3).astype(np.int32)
    return MeshSequence(corners, faces, np.array(25, np.float32)), TextureAtlas(uv, faces_uv, image)


@pytest.mark.parametrize("index", [0, 3, 6])
def test_the_silhouette_is_the_true_matte(block, index):
    mesh, texture = block
    picture = film(
        mesh, texture, camera(index), noise=0, spill=0, shadow=0, unevenness=0, supersampling=4
    ).images
    alpha = true_mattes(mesh, camera(index), supersampling=4).alpha
    backdrop = np.array(BACKDROPS["blue"])
    is_backdrop = np.abs(picture.astype(int) - backdrop).max(axis=-1) <= 1
    assert np.array_equal(is_backdrop[alpha == 0], np.ones((alpha == 0).sum(), bool))
    assert not is_backdrop[alpha > 40].any()
    assert (alpha == 255).sum() > 1000


def test_edges_are_mixed_by_coverage(block):
    mesh, texture = block
    dark = texture._replace(image=np.zeros_like(texture.image))
    picture = film(mesh, dark, camera(1), noise=0, spill=0, shadow=0, unevenness=0, supersampling=4).images
    alpha = true_mattes(mesh, camera(1), supersampling=4).alpha / 255
    expected = (1 - alpha[..., None]) * np.array(BACKDROPS["blue"])
    np.testing.assert_allclose(picture, expected, atol=1.2)


def test_noise_has_its_deviation_and_differs_by_frame_camera_and_seed(block):
    mesh, texture = block
    clean = film(mesh, texture, camera(2), noise=0).images.astype(float)
    noisy = film(mesh, texture, camera(2), noise=5.0).images.astype(float)
    flat = (clean > 60).all(-1) & (clean < 200).all(-1)
    expected = np.sqrt(25 * (0.2 + 0.8 * clean[flat].mean() / 255))
    assert (noisy - clean)[flat].std() == pytest.approx(expected, rel=0.1)
    again = film(mesh, texture, camera(2), noise=5.0).images
    assert np.array_equal(again, noisy)
    other_seed = film(mesh, texture, camera(2), noise=5.0, seed=1).images
    moved = film(
        mesh._replace(vertices=mesh.vertices + np.float32(1e-4)), texture, camera(2), noise=5.0
    ).images
    assert (other_seed != again).mean() > 0.5
    assert (moved[:20] != again[:20]).mean() > 0.5


def test_spill_tints_towards_the_backdrop_and_shadow_darkens_the_floor(block):
    mesh, texture = block
    plain = film(mesh, texture, camera(4), noise=0, spill=0, shadow=0).images.astype(float)
    spilled = film(mesh, texture, camera(4), noise=0, spill=0.6, shadow=0).images.astype(float)
    alpha = true_mattes(mesh, camera(4)).alpha
    inside = alpha == 255
    assert (spilled - plain)[inside][:, 2].mean() > 3
    shaded = film(mesh, texture, camera(4), noise=0, spill=0, shadow=1.0).images.astype(float)
    outside = alpha == 0
    assert (plain - shaded)[outside].max() > 15
    assert np.array_equal(shaded[inside], plain[inside])


def test_backdrops_and_casts(block):
    mesh, texture = block
    green = film(mesh, texture, camera(5), backdrop="green", noise=0).images[2, 2]
    assert green.argmax() == 1
    casts = [
        film(mesh, texture, camera(k), noise=0, colour_cast=0.1, unevenness=0).images[2, 2] for k in (0, 1)
    ]
    assert np.abs(casts[0].astype(int) - casts[1]).max() > 2


def test_an_empty_view_is_only_backdrop(block):
    mesh, texture = block
    away = mesh._replace(vertices=mesh.vertices + np.array([0, 50, 0], np.float32))
    picture = film(away, texture, camera(0), noise=0, unevenness=0).images
    assert (np.abs(picture.astype(int) - BACKDROPS["blue"]) <= 1).all()
    assert not true_mattes(away, camera(0)).alpha.any()


def test_a_foreign_texture_is_refused(block):
    mesh, texture = block
    with pytest.raises(ValueError, match=r"one uv triangle per face of the mesh \(12\), got 11"):
        film(mesh, texture._replace(faces_uv=texture.faces_uv[:-1]), camera(0))
