import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.backdrop import backdrop
from reperform.nodes.kernels.camera import look_at, project

MATRIX = np.array([[250.0, 0, 149.5], [0, 250, 99.5], [0, 0, 1]])
BOX = trimesh.creation.box((0.4, 1.0, 0.3))
VERTICES = np.asarray(BOX.vertices) + (0.7, 0.5, -0.4)


def stage(**options) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
    pose = look_at(np.array([0.5, 2.0, 3.5]), np.array([0.4, 0.2, -0.4]))
    return backdrop(MATRIX, *pose, 200, 300, VERTICES, BOX.faces, **options)[..., 0], pose


def at(picture, pose, point) -> float:
    (x, y), _ = project(np.array([point]), MATRIX, *pose)[0][0], None
    return float(picture[round(y), round(x)])


def test_the_shadow_lies_where_the_light_throws_it():
    lit, pose = stage(shadow=0.0, grid=0.0)
    dark, _ = stage(shadow=0.6, grid=0.0)
    # the middle of the box, half a metre up, along the light: (0.35, -1, -0.3)
    assert at(dark, pose, (0.7 + 0.175, 0, -0.4 - 0.15)) < 0.7 * at(lit, pose, (0.7 + 0.175, 0, -0.4 - 0.15))
    np.testing.assert_allclose(at(dark, pose, (-0.7, 0, 0.6)), at(lit, pose, (-0.7, 0, 0.6)), rtol=1e-3)
    assert (dark <= lit + 1e-3).all()


def test_grid_lines_are_where_they_should_be():
    plain, pose = stage(shadow=0.0, grid=0.0)
    lined, _ = stage(shadow=0.0, grid=0.5)
    assert at(lined, pose, (0.0, 0, 0.27)) < 0.97 * at(plain, pose, (0.0, 0, 0.27))
    assert at(lined, pose, (0.27, 0, 0.5)) < 0.97 * at(plain, pose, (0.27, 0, 0.5))
    assert at(lined, pose, (0.27, 0, 0.27)) == at(plain, pose, (0.27, 0, 0.27))


def test_no_horizon_shows():
    rotation, translation = look_at(np.array([0, 1.5, 4]), np.array([0, 1.5, 0]))
    picture = backdrop(MATRIX, rotation, translation, 200, 300, VERTICES, BOX.faces[:0], grid=0.0)
    assert np.abs(np.diff(picture[:, 150, 0])).max() < 2


def test_brightness_is_the_share_of_white():
    rotation, translation = look_at(np.array([0, 1.5, 4]), np.array([0, 9.5, 0]))
    picture = backdrop(MATRIX, rotation, translation, 50, 60, VERTICES, BOX.faces, brightness=0.4)
    assert picture[0, 0, 0] == pytest.approx(102, abs=0.1)
