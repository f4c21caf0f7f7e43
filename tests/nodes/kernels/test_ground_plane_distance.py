import numpy as np

from reperform.nodes.kernels.ground_plane_distance import ground_plane_distance


def test_known_angle_by_hand():
    # two points on a bar: turned by a quarter and lifted by 3 m, only the lift remains
    a = np.array([[[1.0, 0, 0], [-1, 0, 0]]])
    b = np.array([[[5.0, 3, 1], [5, 3, -1]]])
    none = np.zeros_like(a)
    np.testing.assert_allclose(ground_plane_distance(a, b, none, none, 0), 3)
    np.testing.assert_allclose(ground_plane_distance(a, b, none, none, 0, "offset"), np.sqrt(9 + 2))
    plain = np.sqrt(((a[0] - b[0]) ** 2).sum() / 2)
    np.testing.assert_allclose(ground_plane_distance(a, b, none, none, 0, "none"), plain)


def test_vectors_turn_with_the_points():
    a = np.array([[[1.0, 0, 0], [-1, 0, 0], [0, 0, 0.5]]])
    b = np.stack([a[..., 2], a[..., 1], -a[..., 0]], -1)
    u = np.array([[[0.1, 0.2, 0], [0, 0, 0.3], [0, 0, 0]]])
    v = np.stack([u[..., 2], u[..., 1], -u[..., 0]], -1)
    np.testing.assert_allclose(ground_plane_distance(a, b, u, v, 4.0), 0, atol=1e-7)
    np.testing.assert_allclose(ground_plane_distance(a, a, u, -u, 4.0) ** 2, 4 * 4 * (u**2).sum() / 3)
