import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.camera import look_at, project
from reperform.nodes.kernels.rasterise import interpolate, rasterise

HEIGHT, WIDTH = 173, 241
MATRIX = np.array([[260.0, 0, 131.3], [0, 244.0, 77.7], [0, 0, 1]])


def scene() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """An off-centre ellipsoid of three radii before a tilted, turned box."""
    ellipsoid = trimesh.creation.icosphere(subdivisions=4)
    box = trimesh.creation.box((0.5, 1.3, 0.2))
    box.apply_transform(trimesh.transformations.euler_matrix(0.3, 0.5, -0.2))
    vertices = np.concatenate(
        [ellipsoid.vertices * (0.3, 0.45, 0.2) + (0.25, 0.1, 0.1), box.vertices - (0.2, 0, 0.3)]
    )
    faces = np.concatenate([ellipsoid.faces, box.faces + len(ellipsoid.vertices)]).astype(np.int32)
    rotation, translation = look_at(np.array([0.9, 0.8, 2.1]), np.array([0.05, 0, 0]))
    return vertices, faces, rotation, translation


def test_agrees_with_ray_casting():
    import open3d

    vertices, faces, rotation, translation = scene()
    ids, barycentric, depth = rasterise(
        *project(vertices, MATRIX, rotation, translation), faces, HEIGHT, WIDTH
    )
    caster = open3d.t.geometry.RaycastingScene()
    caster.add_triangles(vertices.astype(np.float32), faces.astype(np.uint32))
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    directions = np.stack([x, y, np.ones_like(x)], -1) @ np.linalg.inv(MATRIX).T @ rotation
    eye = np.broadcast_to(-rotation.T @ translation, directions.shape)
    hits = caster.cast_rays(np.concatenate([eye, directions], -1).astype(np.float32))
    expected_ids = hits["primitive_ids"].numpy().astype(np.int64)
    expected_ids[expected_ids == 0xFFFFFFFF] = -1
    # float32 rays graze edges differently
    same = ids == expected_ids
    assert (~same).sum() <= 8
    hit = same & (ids >= 0)
    assert hit.mean() > 0.15
    uv = hits["primitive_uvs"].numpy()
    np.testing.assert_allclose(barycentric[hit][:, 1:], uv[hit], atol=5e-3)
    np.testing.assert_allclose(depth[hit], hits["t_hit"].numpy()[hit], rtol=1e-4)
    assert np.isinf(depth[ids < 0]).all()


def test_barycentrics_give_the_point_on_the_pixels_ray():
    vertices, faces, rotation, translation = scene()
    ids, barycentric, depth = rasterise(
        *project(vertices, MATRIX, rotation, translation), faces, HEIGHT, WIDTH
    )
    y, x = np.nonzero(ids >= 0)
    points = interpolate(vertices, faces, ids[y, x], barycentric[y, x])
    pixels, distance = project(points, MATRIX, rotation, translation)
    np.testing.assert_allclose(pixels, np.stack([x, y], 1), atol=2e-3)
    np.testing.assert_allclose(distance, depth[y, x], rtol=1e-5)


def test_shared_edges_are_neither_doubled_nor_dropped():
    """A triangulated rectangle with vertices on pixel centres: each pixel in exactly one triangle."""
    random = np.random.default_rng(5)
    inner = random.integers(1, 20, (40, 2))
    corners = np.array([[0, 0], [20, 0], [0, 20], [20, 20]])
    from scipy.spatial import Delaunay

    points = np.unique(np.concatenate([inner, corners]), axis=0).astype(float)
    faces = Delaunay(points).simplices.astype(np.int32)
    ones = np.ones(len(points))
    covered = np.zeros((24, 26), int)
    for face in faces:
        covered += rasterise(points, ones, face[None], 24, 26)[0] == 0
    expected = np.zeros_like(covered)
    # top and left edges belong to the rectangle, bottom and right ones do not
    expected[0:20, 0:20] = 1
    np.testing.assert_array_equal(covered, expected)


def test_coverage_of_a_closed_mesh_is_watertight():
    """Without distortion the silhouette of a convex closed mesh is convex: no pixel inside is dropped."""
    vertices, faces, rotation, translation = scene()
    ellipsoid = faces[faces.max(axis=1) < 2562]
    pixels, depth = project(vertices, MATRIX, rotation, translation)
    covered = rasterise(pixels, depth, ellipsoid, HEIGHT, WIDTH)[0] >= 0
    assert covered.sum() > 3000
    for line in (*covered, *covered.T):
        inside = np.flatnonzero(line)
        assert inside.size == 0 or inside.size == inside[-1] - inside[0] + 1


def test_by_hand():
    """One triangle, twice as deep at one corner: the hyperbolic midpoint, not the linear one."""
    pixels, depth = np.array([[0.0, 0], [4, 0], [0, 4]]), np.array([1.0, 2.0, 1.0])
    ids, barycentric, z = rasterise(pixels, depth, np.array([[0, 1, 2]]), 6, 6)
    assert (ids >= 0).sum() == 4 + 3 + 2 + 1
    np.testing.assert_allclose(barycentric[0, 2], [2 / 3, 1 / 3, 0])
    assert z[0, 2] == pytest.approx(4 / 3)
    flipped = rasterise(pixels, depth, np.array([[0, 2, 1]]), 6, 6)
    np.testing.assert_array_equal(flipped[0], ids)
    np.testing.assert_array_equal(flipped[1][..., [0, 2, 1]], barycentric)


def test_unusable_triangles_are_left_out():
    pixels = np.array([[0.0, 0], [9, 0], [0, 9], [np.nan, 3], [5, 1e9]])
    depth = np.array([1.0, 1, 1, 1, 1])
    for third in (3, 4):
        assert (rasterise(pixels, depth, np.array([[0, 1, third]]), 10, 10)[0] == -1).all()
    depth[1] = -1
    assert (rasterise(pixels, depth, np.array([[0, 1, 2]]), 10, 10)[0] == -1).all()
    with pytest.raises(ValueError, match="must index the 5 vertices"):
        rasterise(pixels, depth, np.array([[0, 1, 5]]), 10, 10)
