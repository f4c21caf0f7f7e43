import numpy as np
import pytest

from reperform.nodes.products.mesh import MeshSequence, TextureAtlas
from reperform.nodes.texture.vertex_colours import vertex_colours


def _scene():
    vertices = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0], [3, 1, 0]]], np.float32)
    faces = np.array([[0, 1, 2], [1, 3, 2]], np.int32)
    # red grows with u, green with v, one step per pixel
    y, x = np.mgrid[:100, :200]
    image = np.stack([x, 199 - 2 * y, np.full_like(x, 40)], axis=-1).astype(np.uint8)
    uv = np.array([[0.1, 0.1], [0.4, 0.1], [0.1, 0.7], [0.6, 0.2], [0.9, 0.2], [0.6, 0.5]], np.float32)
    atlas = TextureAtlas(uv, np.array([[0, 1, 2], [3, 4, 5]], np.int32), image)
    return MeshSequence(vertices, faces, np.float32(25)), atlas


def test_a_linear_picture_gives_the_middle_of_each_face():
    mesh, atlas = _scene()
    colour = vertex_colours(mesh, atlas, samples=16, smooth=0).colour.astype(float)
    first, second = np.array([0.2 * 200, 0.3 * 200, 40]), np.array([0.7 * 200, 0.3 * 200, 40])
    np.testing.assert_allclose(colour, [first, (first + second) / 2, (first + second) / 2, second], atol=1.6)


def test_smoothing_draws_neighbours_together_and_keeps_constants():
    mesh, atlas = _scene()
    sharp, soft = (vertex_colours(mesh, atlas, smooth=n).colour.astype(int) for n in (0, 5))
    assert np.ptp(soft[:, 0]) < np.ptp(sharp[:, 0]) / 2
    assert (soft[:, 2] == 40).all()


def test_refuses_another_mesh():
    mesh, atlas = _scene()
    with pytest.raises(ValueError, match="of the 2 faces"):
        vertex_colours(mesh, atlas._replace(faces_uv=atlas.faces_uv[:1]))
