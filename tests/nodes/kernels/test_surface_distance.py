"""Mean distances of surfaces with known ones."""

import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.surface_distance import mean_distance


def test_distance_to_a_parallel_plane_is_exact():
    low = np.array([[0, 0, 0], [3, 0, 0], [3, 0, 2], [0, 0, 2.0]])
    faces = np.array([[0, 2, 1], [0, 3, 2]])
    high = low * [0.4, 1, 0.4] + [0.3, 0.7, 0.5]
    assert mean_distance(high, faces, low, faces) == pytest.approx(0.7)


def test_it_weighs_by_area_not_by_vertices():
    # a step whose lower tread is 3 m^2 at distance 0.1 and split finely, its upper one 1 m^2 at 0.5
    coarse = trimesh.creation.box([1, 0.001, 1])
    fine = trimesh.creation.box([3, 0.001, 1])
    dense = fine.subdivide().subdivide().subdivide()
    coarse.apply_translation([2.5, 0.5, 0])
    dense.apply_translation([0, 0.1, 0])
    step = trimesh.util.concatenate([dense, coarse])
    floor = trimesh.creation.box([20, 1e-6, 20])
    found = mean_distance(step.vertices, step.faces, floor.vertices, floor.faces)
    assert found == pytest.approx((3 * 0.1 + 1 * 0.5) / 4, rel=0.01)
    assert step.vertices[:, 1].mean() < 0.13


def test_two_ellipsoids_agree_with_open3d():
    import open3d

    one, other = trimesh.creation.icosphere(3), trimesh.creation.icosphere(4)
    a = one.vertices * [0.31, 0.52, 0.23] + [0.02, 0.9, -0.1]
    b = other.vertices * [0.35, 0.5, 0.2] + [0.0, 0.93, -0.07]
    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(b.astype(np.float32), other.faces.astype(np.uint32))
    distance = scene.compute_distance(a.astype(np.float32)).numpy()
    areas = np.zeros(len(a))
    corners = trimesh.Trimesh(a, one.faces, process=False)
    np.add.at(areas, one.faces, corners.area_faces[:, None] / 3)
    expected = areas @ distance / areas.sum()
    assert mean_distance(a, one.faces, b, other.faces) == pytest.approx(expected, rel=1e-5)


def test_a_mesh_without_area_has_no_distance():
    point, face = np.zeros((3, 3)), np.array([[0, 1, 2]])
    assert np.isnan(mean_distance(point, face, np.eye(3), face))
