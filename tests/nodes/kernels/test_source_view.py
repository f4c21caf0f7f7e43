import numpy as np

from reperform.nodes.kernels.source_view import source_view

# A camera at the origin that looks along z: 100 px per unit of slope.
CAMERA = (np.array([[100.0, 0, 60], [0, 100, 50], [0, 0, 1]]), np.eye(3), np.zeros(3), np.zeros(5))


def plate(left: float, right: float, depth: float) -> np.ndarray:
    return np.array([[left, -0.3, depth], [right, -0.3, depth], [right, 0.3, depth], [left, 0.3, depth]])


FACES = np.array([[0, 1, 2], [0, 2, 3]])


def view(vertices, faces, alpha=None, **options):
    image = np.arange(100 * 120 * 3, dtype=np.uint32).astype(np.uint8).reshape(100, 120, 3)
    alpha = np.full((100, 120), 255, np.uint8) if alpha is None else alpha
    return image, source_view(image, alpha, vertices, faces, CAMERA, **options)


def test_crop_depth_and_trust_of_a_plate():
    image, made = view(plate(-0.4, 0.2, 2.0), FACES, erode=1.0, feather=4.0)
    x, y = made.origin.astype(int)
    np.testing.assert_array_equal(made.image, image[y : y + made.image.shape[0], x : x + made.image.shape[1]])
    assert made.depth[50 - y, 55 - x] == 2
    assert np.isinf(made.depth[0, 0])
    row = made.trust[50 - y]
    # the plate spans x = 40 .. 69 (right edge open)
    assert row[40 - x] == 0
    assert 0 < row[41 - x] < row[42 - x] < row[43 - x] < 1
    assert row[46 - x] == row[63 - x] == 1
    np.testing.assert_allclose(row[41 - x : 69 - x], row[41 - x : 69 - x][::-1], atol=1e-6)


def test_a_hole_in_the_matte_is_not_trusted():
    alpha = np.full((100, 120), 255, np.uint8)
    alpha[48:52, 53:57] = 100
    _, made = view(plate(-0.4, 0.2, 2.0), FACES, alpha, erode=1.0, feather=4.0)
    x, y = made.origin.astype(int)
    assert (made.trust[48 - y : 52 - y, 53 - x : 57 - x] == 0).all()
    assert made.trust[50 - y, 46 - x] > made.trust[50 - y, 51 - x]


def test_a_step_of_depth_is_not_trusted_a_slope_is():
    step = np.concatenate([plate(-0.4, 0.4, 2.0), plate(-0.1, 0.1, 1.9)])
    faces = np.concatenate([FACES, FACES + 4])
    _, made = view(step, faces, erode=1.0, feather=2.0)
    x, y = made.origin.astype(int)
    edges = np.flatnonzero(np.abs(np.diff(made.depth[50 - y, 42 - x : 78 - x])) > 0.05) + 42
    assert len(edges) == 2
    for edge in edges:
        assert (made.trust[50 - y, edge - x : edge + 2 - x] == 0).all()
    slope = plate(-0.4, 0.4, 2.0)
    slope[:, 2] += slope[:, 0]
    _, made = view(slope, FACES, erode=1.0, feather=2.0)
    x, y = made.origin.astype(int)
    assert made.trust[50 - y, 60 - x] == 1


def test_out_of_the_picture_is_none():
    assert view(plate(-0.4, 0.2, -2.0), FACES)[1] is None
    assert view(plate(5, 6, 2.0), FACES)[1] is None
