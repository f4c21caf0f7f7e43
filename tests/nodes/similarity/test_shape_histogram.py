import numpy as np
import pytest
import trimesh

from reperform.nodes.products.mesh import Surfaces
from reperform.nodes.similarity.shape_histogram import shape_histogram


def _lump():
    """Two overlapping ellipsoids, off centre: no symmetry."""
    body = trimesh.creation.icosphere(3)
    body.apply_scale((0.2, 0.8, 0.15))
    arm = trimesh.creation.icosphere(2)
    arm.apply_scale((0.35, 0.07, 0.09))
    arm.apply_translation((0.5, 0.4, 0.05))
    mesh = trimesh.util.concatenate([body, arm])
    mesh.apply_translation((0.7, 1.1, -0.4))
    return mesh


def _surfaces(mesh):
    return Surfaces(mesh.vertices.astype(np.float32), mesh.faces.astype(np.int32), np.float32(25))


def test_agrees_with_counted_points_inside_an_ellipsoid():
    ball = trimesh.creation.icosphere(4)
    ball.apply_scale((0.3, 0.9, 0.2))
    ball.apply_translation((1.0, 0.9, -2.0))
    histograms = shape_histogram(_surfaces(ball), radial=4, polar=6, azimuth=12, reach=1.0)
    points = np.random.default_rng(0).uniform(-1, 1, (400_000, 3))
    points = points[(points**2).sum(1) < 1] * (0.3, 0.9, 0.2)
    r = np.linalg.norm(points, axis=1)
    shell = np.bincount((r * 4).astype(int), minlength=4) / len(points)
    np.testing.assert_allclose(histograms.share.sum((1, 2)), shell, atol=0.004)
    polar = np.bincount((np.arccos(points[:, 1] / r) / np.pi * 6).astype(int), minlength=6) / len(points)
    np.testing.assert_allclose(histograms.share.sum((0, 2)), polar, atol=0.03)
    np.testing.assert_allclose(histograms.centre, (1.0, 0.9, -2.0), atol=1e-4)


def test_sums_to_one_and_ignores_where_it_stands():
    mesh = _lump()
    first = shape_histogram(_surfaces(mesh))
    mesh.apply_translation((2.0, 0.3, 1.0))
    second = shape_histogram(_surfaces(mesh))
    assert first.share.shape == (8, 12, 60)
    np.testing.assert_allclose(first.share.sum(), 1, rtol=1e-5)
    np.testing.assert_allclose(first.share, second.share, atol=2e-6)


@pytest.mark.parametrize("bins", [7, -4])
def test_a_turn_by_whole_bins_rolls_the_azimuth(bins):
    mesh = _lump()
    first = shape_histogram(_surfaces(mesh)).share
    mesh.apply_transform(trimesh.transformations.rotation_matrix(2 * np.pi * bins / 60, (0, 1, 0)))
    second = shape_histogram(_surfaces(mesh)).share
    np.testing.assert_allclose(np.roll(first, bins, axis=2), second, atol=1e-6)


def test_volume_past_the_reach_stays_in_the_outermost_shell():
    histograms = shape_histogram(_surfaces(_lump()), reach=0.3, radial=3)
    np.testing.assert_allclose(histograms.share.sum(), 1, rtol=1e-5)
    assert histograms.share[2].sum() > 0.3


def test_refuses_meshes_without_volume():
    mesh = _surfaces(_lump())
    with pytest.raises(ValueError, match=r"positive volume \(m\^3\)"):
        shape_histogram(mesh._replace(faces=mesh.faces[:, ::-1].copy()))
    with pytest.raises(ValueError, match="positive volume"):
        shape_histogram(Surfaces(np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int32), np.float32(25)))
