import numpy as np
import pytest
from scipy.optimize import minimize

from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.similarity.vertex_velocity import vertex_velocity

FACES = np.array([[0, 1, 2], [0, 2, 3]], np.int32)


def _turn(points, yaw, offset=(0.0, 0.0, 0.0)):
    c, s = np.cos(yaw), np.sin(yaw)
    return points @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T + offset


def _take(seed, frames, vertices=7):
    points = np.random.default_rng(seed).normal(size=(frames, vertices, 3)) * (0.3, 0.8, 0.2)
    return MeshSequence(points.astype(np.float32), FACES, np.float32(25))


def test_agrees_with_numerical_minimisation_over_the_ground_plane():
    a, b, weight = _take(0, 3), _take(1, 4), 0.7
    distance = vertex_velocity((a, b), velocity_weight=weight).distance
    i, j = 2, 3
    u, v = a.vertices[2] - a.vertices[1], b.vertices[3] - b.vertices[2]

    def cost(p):
        shape = a.vertices[i] - _turn(b.vertices[j], p[0], (p[1], 0, p[2]))
        return ((shape**2).sum() + weight * ((u - _turn(v, p[0])) ** 2).sum()) / 7

    best = min(minimize(cost, (yaw, 0, 0)).fun for yaw in (0, 2, 4))
    np.testing.assert_allclose(distance[i, j], np.sqrt(best), rtol=1e-5)


def test_turning_and_shifting_a_take_changes_nothing():
    a, b = _take(2, 5), _take(3, 4)
    moved = b._replace(vertices=_turn(b.vertices, 1.9, (3.0, 0, -2.0)).astype(np.float32))
    np.testing.assert_allclose(
        vertex_velocity((a, b)).distance, vertex_velocity((a, moved)).distance, atol=1e-5
    )
    assert np.abs(vertex_velocity((b, moved)).distance.diagonal()).max() < 1e-5


def test_without_alignment_it_is_the_plain_formula():
    a, b = _take(4, 4), _take(5, 3)
    distance = vertex_velocity((a, b), velocity_weight=2.0, align="none").distance
    u, v = a.vertices[1] - a.vertices[0], b.vertices[2] - b.vertices[1]
    square = ((a.vertices[0] - b.vertices[2]) ** 2).sum() + 2 * ((u - v) ** 2).sum()
    np.testing.assert_allclose(distance[0, 2], np.sqrt(square / 7), rtol=1e-5)


def test_height_counts_and_swapping_the_takes_transposes():
    a = _take(6, 3)
    higher = a._replace(vertices=a.vertices + np.float32([0, 0.25, 0]))
    np.testing.assert_allclose(vertex_velocity((a, higher)).distance.diagonal(), 0.25, rtol=1e-5)
    b = _take(7, 5)
    np.testing.assert_allclose(
        vertex_velocity((a, b)).distance, vertex_velocity((b, a)).distance.T, rtol=1e-6, atol=1e-7
    )


def test_velocity_tells_opposite_motions_of_one_pose_apart():
    shape = np.random.default_rng(8).normal(size=(7, 3))
    move = np.random.default_rng(9).normal(size=(7, 3)) * 0.1
    forth = np.stack([shape - move, shape, shape + move]).astype(np.float32)
    a = MeshSequence(forth, FACES, np.float32(25))
    back = a._replace(vertices=forth[::-1].copy())
    assert vertex_velocity((a, back), velocity_weight=0.0).distance[1, 1] < 1e-6
    assert vertex_velocity((a, back), velocity_weight=1.0).distance[1, 1] > 0.1


def test_refuses_other_topology_and_frame_rate():
    a = _take(0, 3)
    with pytest.raises(ValueError, match=r"share one topology.*align\.register"):
        vertex_velocity((a, a._replace(faces=FACES[:, ::-1].copy())))
    with pytest.raises(ValueError, match="one frame rate"):
        vertex_velocity((a, a._replace(fps=np.float32(50))))


def test_single_frame_has_no_velocity():
    assert vertex_velocity((_take(0, 1), _take(0, 1))).distance.shape == (1, 1)
