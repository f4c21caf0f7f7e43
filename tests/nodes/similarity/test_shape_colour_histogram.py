import numpy as np
import pytest

from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.vertex_colours import VertexColours
from reperform.nodes.similarity.shape_colour_histogram import shape_colour_histogram


def _soup(seed=0, faces=60):
    """Loose coloured triangles: no symmetry, areas known one by one."""
    rng = np.random.default_rng(seed)
    corners = rng.normal(size=(faces, 1, 3)) * (0.2, 0.5, 0.3) + 0.05 * rng.normal(size=(faces, 3, 3))
    vertices = (corners.reshape(-1, 3) + (3, 1, -2)).astype(np.float32)
    mesh = MeshSequence(vertices, np.arange(3 * faces, dtype=np.int32).reshape(-1, 3), np.float32(25))
    return mesh, VertexColours(rng.integers(0, 256, (3 * faces, 3)).astype(np.uint8))


def _turned(mesh, yaw, offset):
    c, s = np.cos(yaw), np.sin(yaw)
    turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return mesh._replace(vertices=(mesh.vertices @ turn.T + offset).astype(np.float32))


def test_shares_are_areas_and_means_are_kept():
    mesh, colours = _soup()
    found = shape_colour_histogram(mesh, colours)
    np.testing.assert_allclose(found.share.sum(), 1)
    assert (np.diff(found.bin) > 0).all()
    np.testing.assert_allclose(found.share @ found.point, 0, atol=1e-6)
    tri = mesh.vertices[mesh.faces].astype(float)
    area = np.linalg.norm(np.cross(tri[:, 1] - tri[:, 0], tri[:, 2] - tri[:, 0]), axis=1)
    colour = (colours.colour[mesh.faces].mean(axis=1) / 255).T @ area / area.sum()
    np.testing.assert_allclose(found.share @ found.colour, colour, atol=1e-6)
    np.testing.assert_allclose(found.centre, tri.mean(axis=1).T @ area / area.sum(), rtol=1e-5)


def test_every_mean_lies_in_its_bin():
    mesh, colours = _soup(1)
    found = shape_colour_histogram(mesh, colours, radial=3, polar=4, azimuth=6, channel=2)
    r, p, k, *rgb = np.unravel_index(found.bin, (3, 4, 6, 2, 2, 2))
    np.testing.assert_array_equal(np.array(rgb).T, np.minimum(np.floor(found.colour * 2), 1))
    x, y, z = found.point.T
    assert (np.hypot(np.hypot(x, y), z) <= (r + 1) * 0.4 + 1e-6)[r < 2].all()
    one_vertex = np.isclose(np.hypot(np.hypot(x, y), z), 0.4 * (r + 0.5), atol=0.2) & (r < 2)
    azimuth = np.floor(np.arctan2(x, z) / (2 * np.pi) % 1 * 6)
    np.testing.assert_array_equal(azimuth[one_vertex], k[one_vertex])
    assert ((np.arccos(y / np.hypot(np.hypot(x, y), z)) / np.pi * 4 - p) < 1.3).all()


def test_a_turn_by_whole_bins_turns_the_bins():
    mesh, colours = _soup(2)
    first = shape_colour_histogram(mesh, colours)
    second = shape_colour_histogram(_turned(mesh, 2 * np.pi * 3 / 20, (5, 0, 1)), colours)
    cells = np.array(np.unravel_index(first.bin, first.bins))
    cells[2] = (cells[2] + 3) % 20
    order = np.argsort(np.ravel_multi_index(cells, first.bins))
    np.testing.assert_allclose(first.share[order], second.share, atol=1e-5)


def test_refuses_other_colours_and_no_surface():
    mesh, colours = _soup()
    with pytest.raises(ValueError, match="of the 180 vertices"):
        shape_colour_histogram(mesh, VertexColours(colours.colour[1:]))
    with pytest.raises(ValueError, match="must have an area"):
        shape_colour_histogram(mesh._replace(vertices=np.zeros_like(mesh.vertices)), colours)
