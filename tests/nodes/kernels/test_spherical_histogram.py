import numpy as np
import trimesh

from reperform.nodes.kernels.spherical_histogram import spherical_histogram, volume_centroid


def test_volume_and_centroid_agree_with_trimesh():
    cone = trimesh.creation.cone(0.3, 1.1)
    cone.apply_translation((2, -1, 0.5))
    volume, centre = volume_centroid(cone.vertices, cone.faces.astype(np.int32))
    np.testing.assert_allclose(volume, cone.volume)
    np.testing.assert_allclose(centre, cone.center_mass)


def test_shells_of_a_ball_are_exact():
    ball = trimesh.creation.icosphere(4, 0.5)
    h = spherical_histogram(ball.vertices, ball.faces.astype(np.int32), np.zeros(3), 0.5, 5, 6, 8)
    inner = 4 / 3 * np.pi * (np.arange(1, 6) / 10) ** 3
    np.testing.assert_allclose(h.sum((1, 2))[:4], np.diff(inner, prepend=0)[:4], rtol=4e-3)
    np.testing.assert_allclose(h.sum(), ball.volume, rtol=1e-12)


def test_azimuth_runs_from_z_towards_x():
    box = trimesh.creation.box((0.02, 0.2, 0.02))
    for place, azimuth in (((0, 0, 1.0), 0), ((1.0, 0, 0), 90), ((0, 0, -1.0), 180), ((-1.0, 0, 0), 270)):
        moved = box.copy()
        moved.apply_translation(place)
        h = spherical_histogram(moved.vertices, moved.faces.astype(np.int32), np.zeros(3), 1.2, 1, 1, 36)
        angle = np.deg2rad(np.arange(36) * 10 + 5)
        mean = np.angle((h[0, 0] * np.exp(1j * angle)).sum(), deg=True) % 360
        assert abs((mean - azimuth + 180) % 360 - 180) < 0.5


def test_a_hollow_is_not_counted():
    outer, inner = trimesh.creation.icosphere(3, 0.5), trimesh.creation.icosphere(3, 0.25)
    inner.invert()
    shell = trimesh.util.concatenate([outer, inner])
    h = spherical_histogram(shell.vertices, shell.faces.astype(np.int32), np.zeros(3), 0.5, 2, 4, 8)
    assert abs(h[0].sum()) < 0.02 * h.sum()
