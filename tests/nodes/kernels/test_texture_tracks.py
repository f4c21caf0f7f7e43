import cv2
import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.camera import centre, look_at, project
from reperform.nodes.kernels.mesh_geometry import vertex_normals
from reperform.nodes.kernels.texture_tracks import Sights, add_sight_pull, see, track, track_surface

MATRIX = np.array([[300.0, 0, 159.5], [0, 300.0, 119.5], [0, 0, 1]])
LENS = np.array([-0.1, 0.02, 0.001, -0.002, 0.0])
EYES = ((0.3, 0.4, 2.5), (1.6, 0.9, 1.9), (-1.2, 0.6, 2.1))


def _camera(eye):
    return (MATRIX, *look_at(np.array(eye), np.array([0.0, 0.1, 0.0])), LENS)


def _picture(plane, camera):
    """A textured plane z = 0, shifted by `plane`, as a camera sees it: exact per pixel."""
    grid = np.stack(np.meshgrid(np.arange(320.0), np.arange(240.0)), -1).reshape(-1, 1, 2)
    ideal = cv2.undistortPoints(grid, camera[0], camera[3])[:, 0]
    ray = np.column_stack([ideal, np.ones(len(ideal))]) @ camera[1]
    eye = centre(camera[1], camera[2])
    x, y = (eye[:2] - eye[2] / ray[:, 2:] * ray[:, :2] - plane[:2]).T
    value = np.sin(23 * x + 3 * np.sin(7 * y)) + np.sin(31 * y + 2 * np.cos(9 * x)) + np.sin(13 * x - 17 * y)
    return np.clip(128 + 40 * value, 0, 255).astype(np.uint8).reshape(240, 320)


@pytest.fixture(scope="module")
def sheet():
    x, y = np.meshgrid(np.linspace(-0.4, 0.4, 17), np.linspace(-0.3, 0.3, 13))
    index = np.arange(x.size).reshape(x.shape)
    a, b, c, d = (index[i : i - 1 or None, j : j - 1 or None] for i, j in ((0, 0), (0, 1), (1, 1), (1, 0)))
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()]), faces.astype(np.int32)


def test_a_hidden_side_is_not_seen():
    ball = trimesh.creation.icosphere(3, 0.3)
    seen = see(ball.vertices, ball.vertices / 0.3, ball.faces, _camera(EYES[0]), 240, 320)
    eye = np.array(EYES[0])
    horizon = ball.vertices @ eye > 0.3**2 + 0.1
    assert (seen.facing[horizon] > 0).all()
    assert (seen.facing[ball.vertices @ eye < 0.3**2] == 0).all()


def test_what_stands_in_front_hides(sheet):
    vertices, faces = sheet
    both = np.concatenate([vertices, vertices * 0.5 + (0, 0, 0.4)])
    seen = see(
        both,
        np.tile([0.0, 0, 1], (len(both), 1)),
        np.concatenate([faces, faces + len(vertices)]),
        _camera((0, 0.1, 2.5)),
        240,
        320,
    )
    behind = (abs(vertices[:, 0]) < 0.15) & (abs(vertices[:, 1]) < 0.1)
    assert (seen.facing[: len(vertices)][behind] == 0).all()
    assert (seen.facing[len(vertices) :] > 0.9).all()


def test_tracks_follow_the_texture_from_a_wrong_guess(sheet):
    vertices, _ = sheet
    camera, move = _camera(EYES[0]), np.array([0.03, -0.02, 0.0])
    at, there = project(vertices, *camera)[0], project(vertices + move, *camera)[0]
    found, good = track(_picture(0 * move, camera), _picture(move, camera), at, at + (1.5, 1.0), 2, 1.0)
    assert good.mean() > 0.9
    assert np.median(np.linalg.norm(found - there, axis=1)[good]) < 0.1


def test_lines_of_sight_meet_at_the_moved_points(sheet):
    vertices, faces = sheet
    cameras, move = [_camera(eye) for eye in EYES], np.array([0.03, -0.02, 0.0])
    normals = vertex_normals(vertices, faces)
    seen = [see(vertices, normals, faces, camera, 240, 320) for camera in cameras]
    pictures = [[_picture(m, camera) for camera in cameras] for m in (0 * move, move)]
    sights = track_surface((pictures[0], pictures[1]), (cameras, cameras), (seen, seen), 3, 1.0)
    moved = np.array(vertices)
    for _ in range(10):
        tensor, force = np.zeros((len(moved), 3, 3)), np.zeros((len(moved), 3))
        add_sight_pull(sights, moved, 0.05, 1.0, tensor, force)
        firm = np.linalg.eigvalsh(tensor)[:, 0] > 0.05
        moved[firm] += np.linalg.solve(tensor[firm], force[firm][..., None])[..., 0]
    assert firm.mean() > 0.8
    error = np.linalg.norm(moved - vertices - move, axis=1)[firm]
    assert np.median(error) < 0.002
    assert np.percentile(error, 90) < 0.006


def test_pull_is_sideways_only_and_lets_go_far_off():
    sights = Sights(np.array([0, 1]), np.zeros((2, 3)), np.tile([0.0, 0, 1], (2, 1)), np.array([0.5, 1.0]))
    tensor, force = np.zeros((2, 3, 3)), np.zeros((2, 3))
    add_sight_pull(sights, np.array([[0.01, 0, 2], [0.5, 0, 2]]), 0.1, 2.0, tensor, force)
    weight = 2 * 0.5 * np.exp(-0.005)
    np.testing.assert_allclose(tensor[0], weight * np.diag([1, 1, 0]), atol=1e-15)
    np.testing.assert_allclose(force[0], [-0.01 * weight, 0, 0], atol=1e-15)
    assert not tensor[1].any()
    assert not force[1].any()
