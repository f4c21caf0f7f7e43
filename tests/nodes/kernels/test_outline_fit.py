import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.camera import look_at, project
from reperform.nodes.kernels.mesh_window import at_pixels, mesh_windows, visible_views
from reperform.nodes.kernels.outline_fit import outline_offsets, signed_distance
from reperform.nodes.kernels.rasterise import rasterise

HEIGHT, WIDTH = 200, 260
CENTRE = np.array([0.1, 0.9, -0.2])


def ring() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    poses = [
        look_at(CENTRE + [2.5 * np.sin(a), 0.4 + 0.1 * k, 2.2 * np.cos(a)], CENTRE + [0.05, 0, 0])
        for k, a in enumerate(2 * np.pi * np.arange(5) / 5 + 0.2)
    ]
    matrix = np.array([[420.0, 0, 131], [0, 415, 96], [0, 0, 1]])
    return (
        np.tile(matrix, (5, 1, 1)),
        np.stack([pose[0] for pose in poses]),
        np.stack([pose[1] for pose in poses]),
        np.tile(np.array([-0.1, 0, 0, 0, 0]), (5, 1)),
    )


def ball(radius: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    mesh = trimesh.creation.icosphere(subdivisions=4)
    unit = np.asarray(mesh.vertices)
    return CENTRE + radius * unit, unit, np.asarray(mesh.faces, np.int32)


def mattes(radius: float) -> np.ndarray:
    points, _, faces = ball(radius)
    alpha = []
    for k in range(5):
        pixels, depth = project(points, *(part[k] for part in ring()))
        hit = rasterise(4 * pixels + 1.5, depth, faces, 4 * HEIGHT, 4 * WIDTH)[0] >= 0
        alpha.append(np.rint(255 * hit.reshape(HEIGHT, 4, WIDTH, 4).mean(axis=(1, 3))))
    return np.stack(alpha).astype(np.uint8)


@pytest.mark.parametrize("growth", [0.012, -0.012])
def test_a_ball_of_wrong_size_is_told_the_difference(growth: float) -> None:
    points, normals, faces = ball(0.25)
    windows = mesh_windows(points, normals, faces, ring(), (HEIGHT, WIDTH))
    push, weight = outline_offsets(windows, mattes(0.25 + growth))
    told = weight > 0.5
    assert told.mean() > 0.05
    # vertices beside the rim stand out by less than those on it
    assert np.quantile(np.abs(push[told]), 0.9) == pytest.approx(abs(growth), abs=0.003)
    assert (np.sign(push[told]) == np.sign(growth)).all()


def test_cameras_see_the_side_that_faces_them() -> None:
    points, normals, faces = ball(0.25)
    windows = mesh_windows(points, normals, faces, ring(), (HEIGHT, WIDTH))
    views = visible_views(windows, 3, 0.01, 0.3)
    cosine = np.stack([window.cosine for window in windows if window is not None], axis=1)
    for k in range(3):
        used = views[:, k] >= 0
        assert (cosine[used, views[used, k]] > 0.3).all()
    assert (views[:, 0] == np.where(cosine.max(axis=1) > 0.3, cosine.argmax(axis=1), -1)).mean() > 0.99


def test_what_stands_before_hides() -> None:
    points, normals, faces = ball(0.1)
    eye = -ring()[1][0].T @ ring()[2][0]
    front = points + 0.6 * (eye - CENTRE) / np.linalg.norm(eye - CENTRE)
    both = np.concatenate([points, front])
    windows = mesh_windows(
        both, np.tile(normals, (2, 1)), np.concatenate([faces, faces + len(points)]), ring(), (HEIGHT, WIDTH)
    )
    views = visible_views(windows, 5, 0.03, 0.2)
    assert not (views[: len(points)] == 0).any()
    assert (views[len(points) :] == 0).any()


def test_distance_is_exact_at_a_straight_edge() -> None:
    share = np.clip(np.tile(np.arange(40) - 15.3, (20, 1)) + 0.5, 0, 1)
    field = signed_distance(share)
    np.testing.assert_allclose(field[10, 5:30], np.arange(5, 30) - 15.3, atol=0.6)
    assert field[10, 15] == pytest.approx(-0.3, abs=1e-6)
    assert at_pixels(field, np.array([[np.nan, 3.0], [-5.0, 2.0]]), -99.0).tolist() == [-99.0, -99.0]
