import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.soft_shade import soft_shade


def test_light_shadow_and_their_formula():
    floor = np.array([[-2.0, 0, -2], [-2, 0, 2], [2, 0, 2], [2, 0, -2]])
    roof = trimesh.creation.box((0.6, 0.05, 0.6))
    vertices = np.concatenate([floor, roof.vertices + (0.3, 1.0, -0.2)])
    faces = np.concatenate([[[0, 1, 2], [0, 2, 3]], roof.faces + 4])
    light = np.array([0.1, 1.0, 0.05])
    points = np.array([[0.2, 0, -0.25], [-1.2, 0, 1.1]])
    up = np.broadcast_to([0.0, 1, 0], points.shape)
    albedo = np.full((2, 3), 100.0)
    shaded = soft_shade(points, up, up, albedo, vertices, faces, light)[:, 0]
    cosine = 1 / np.linalg.norm(light)
    assert shaded[0] == pytest.approx(100 * (0.36 + 0.14 + 0.30))
    assert shaded[1] == pytest.approx(100 * (0.36 + 0.14 + 0.30 + 0.42 * cosine))
    grazing = soft_shade(
        points, up, np.broadcast_to([1.0, 0, 0], points.shape), albedo, vertices, faces, light
    )
    assert grazing[0, 0] == pytest.approx(shaded[0] - 20)
