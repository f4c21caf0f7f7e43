import numpy as np
import pytest

from reperform.nodes.kernels.camera import look_at, project
from reperform.nodes.kernels.silhouette import intersection_over_union, silhouette


def test_a_finely_cut_plate_is_drawn_through_the_lens() -> None:
    u, v = np.meshgrid(np.linspace(-1, 0.8, 40), np.linspace(-0.5, 0.7, 30), indexing="ij")
    vertices = np.stack([u.ravel(), v.ravel(), np.full(u.size, 0.2)], axis=1)
    corner = (np.arange(39)[:, None] * 30 + np.arange(29)).ravel()
    faces = np.concatenate(
        [np.stack([corner, corner + 1, corner + 31], 1), np.stack([corner, corner + 31, corner + 30], 1)]
    ).astype(np.int32)
    rotation, translation = look_at(np.array([0.3, 0.2, 2.4]), np.array([0.0, 0.1, 0.2]))
    matrix = np.array([[200.0, 0, 158], [0, 205, 121], [0, 0, 1]])
    distortion = np.array([-0.2, 0.05, 0.003, -0.002, 0.0])
    mask = silhouette(vertices, faces, matrix, rotation, translation, distortion, 240, 320)
    random = np.random.default_rng(0)
    inside = np.column_stack(
        [random.uniform(-0.97, 0.77, 500), random.uniform(-0.47, 0.67, 500), np.full(500, 0.2)]
    )
    outside = np.array([[0.86, 0.1, 0.2], [-1.06, 0.3, 0.2], [0.1, 0.76, 0.2], [-0.3, -0.56, 0.2]])
    for points, expected in ((inside, True), (outside, False)):
        pixels, _ = project(points, matrix, rotation, translation, distortion)
        x, y = pixels.round().astype(int).T
        assert np.all(mask[y, x] == expected)


def test_intersection_over_union_by_hand() -> None:
    first, second = np.zeros((4, 5), bool), np.zeros((4, 5), bool)
    assert intersection_over_union(first, second) == 1
    first[0, :4], second[0, 2:] = True, True
    assert intersection_over_union(first, second) == pytest.approx(2 / 5)
