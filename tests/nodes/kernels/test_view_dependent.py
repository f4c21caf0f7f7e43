import cv2
import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.camera import look_at, project
from reperform.nodes.kernels.source_view import source_view
from reperform.nodes.kernels.view_dependent import view_dependent_colour

MATRIX = np.array([[300.0, 0, 101.5], [0, 290, 80], [0, 0, 1]])
WALL = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])


def view(eye, colour, vertices=WALL, faces=FACES, distortion=(0.0,) * 5):
    rotation, translation = look_at(np.array(eye), np.array([0.05, 0.02, 0]))
    image = np.broadcast_to(np.asarray(colour, np.uint8), (160, 200, 3)).copy()
    alpha = np.full((160, 200), 255, np.uint8)
    return source_view(image, alpha, vertices, faces, (MATRIX, rotation, translation, np.array(distortion)))


def spots(count: int = 40):
    points = np.random.default_rng(0).uniform(-0.2, 0.2, (count, 3)) * (1, 1, 0)
    return points, np.broadcast_to([0.0, 0, 1], points.shape)


def towards(points, eye):
    away = np.array(eye) - points
    return away / np.linalg.norm(away, axis=1, keepdims=True)


def test_bilinear_lookup_through_the_lens_model():
    distortion = np.array([-0.2, 0.05, 0.002, -0.001, 0.01])
    # small triangles: inside one, the lens model is replaced by its straight edges
    fine = trimesh.remesh.subdivide_to_size(WALL, FACES, 0.08)
    plain = view((0.4, 0.3, 2.2), 0, *fine, distortion=distortion)
    random = np.random.default_rng(1).integers(0, 255, plain.image.shape, dtype=np.uint8)
    points, normals = spots()
    colour, reliability = view_dependent_colour(points, normals, None, [plain._replace(image=random)])
    pixels, _ = project(points, MATRIX, plain.rotation, plain.translation, distortion)
    at = (pixels - plain.origin).astype(np.float32)
    expected = cv2.remap(random.astype(np.float32), at[:, :1], at[:, 1:], cv2.INTER_LINEAR)[:, 0]
    assert (reliability > 0.3).all()
    # remap works in 1/32 px
    assert np.abs(colour - expected).max() < 6
    assert np.abs(colour - expected).mean() < 1.5


def test_the_nearest_direction_wins_and_gains_multiply():
    eyes = [(-1.0, 0, 2.0), (1.0, 0, 2.0)]
    views = [view(eyes[0], (200, 0, 0)), view(eyes[1], (0, 100, 0))]
    points, normals = spots()
    for k, expected in enumerate([(200, 0, 0), (0, 100, 0)]):
        colour, _ = view_dependent_colour(points, normals, towards(points, eyes[k]), views, sharpness=8)
        assert np.abs(colour - expected).max() < 1
    middle, _ = view_dependent_colour(points[:1] * 0, normals[:1], np.array([[0, 0, 1.0]]), views)
    np.testing.assert_allclose(middle[0], (100, 50, 0), atol=1)
    gains = np.array([[0.5, 1, 1], [1, 2, 1]])
    matched, _ = view_dependent_colour(
        points[:1] * 0, normals[:1], np.array([[0, 0, 1.0]]), views, gains=gains
    )
    np.testing.assert_allclose(matched[0], (50, 100, 0), atol=1)


def test_behind_something_or_facing_away_nothing_is_known():
    screen = np.array([[-0.5, -0.5, 0.3], [0.1, -0.5, 0.3], [0.1, 0.5, 0.3], [-0.5, 0.5, 0.3]])
    vertices, faces = np.concatenate([WALL, screen]), np.concatenate([FACES, FACES + 4])
    seen = view((0, 0, 2.0), (9, 9, 9), vertices, faces)
    points = np.array([[-0.1, 0, 0], [0.4, 0, 0], [-0.1, 0, 0.3], [0.4, 0, 0]])
    normals = np.array([[0.0, 0, 1], [0, 0, 1], [0, 0, 1], [0, 0, -1]])
    _, reliability = view_dependent_colour(points, normals, None, [seen])
    assert (reliability > 0).tolist() == [False, True, True, False]


def test_visibility_fades_between_one_and_two_biases():
    seen = view((0, 0, 2.0), (9, 9, 9))
    points = np.array([[0.05, 0.02, -depth] for depth in (0.0, 0.05, 0.075, 0.11)])
    normals = np.broadcast_to([0.0, 0, 1], points.shape)
    _, reliability = view_dependent_colour(points, normals, None, [seen], bias=0.05)
    assert reliability[2] / reliability[1] == pytest.approx(0.5, abs=0.03)
    assert reliability[1] == pytest.approx(reliability[0], rel=0.01)
    assert reliability[3] == 0
