import numpy as np
import pytest
import trimesh

from reperform.nodes.capture.refine_calibration import refine_calibration
from reperform.nodes.kernels.camera import look_at
from reperform.nodes.kernels.silhouette import silhouette
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.footage import Mattes

WIDTH, HEIGHT = 200, 150
FPS = np.float32(25)


def rig() -> Cameras:
    poses = []
    for angle in (0.2, 1.3, 2.3, 3.5, 4.4, 5.4):
        poses.append(
            look_at(np.array([3 * np.sin(angle), 1.9, 3.2 * np.cos(angle)]), np.array([0.05, 0.8, 0]))
        )
    return Cameras(
        matrix=np.tile(np.array([[210.0, 0, 99], [0, 208, 74], [0, 0, 1]]), (6, 1, 1)),
        rotation=np.stack([pose[0] for pose in poses]),
        translation=np.stack([pose[1] for pose in poses]),
        distortion=np.zeros((6, 5)),
        image_size=np.tile(np.array([[WIDTH, HEIGHT]], np.int32), (6, 1)),
        name=np.array(list("abcdef")),
    )


def figure(cameras: Cameras) -> Mattes:
    ball = trimesh.creation.icosphere(3)
    parts = (
        (0.2, 0.45, 0.14, 0, 0.7, 0),
        (0.1, 0.13, 0.1, 0.03, 1.25, 0.05),
        (0.35, 0.06, 0.07, 0.25, 0.9, 0.1),
    )
    alpha = np.zeros((1, 6, HEIGHT, WIDTH), np.uint8)
    for part in parts:
        vertices = ball.vertices * part[:3] + part[3:]
        for k in range(6):
            seen = silhouette(vertices, ball.faces, *(field[k] for field in cameras[:4]), HEIGHT, WIDTH)
            alpha[0, k][seen] = 255
    return Mattes(alpha, FPS)


def test_a_shifted_camera_is_found_and_put_back() -> None:
    true = rig()
    mattes = figure(true)
    wrong = true._replace(matrix=true.matrix.copy())
    wrong.matrix[2, :2, 2] += [5, -4]
    found = refine_calibration({"t": mattes}, {"t": wrong}, floor=-1.0)["t"]
    before = np.abs(wrong.matrix - true.matrix)[2, :2, 2]
    after = np.abs(found.matrix - true.matrix)[:, :2, 2]
    assert np.all(after[2] < 0.6 * before)
    assert after.mean() < 1.5


def test_a_coherent_rig_is_left_nearly_alone() -> None:
    true = rig()
    found = refine_calibration({"t": figure(true)}, {"t": true}, floor=-1.0)["t"]
    assert np.abs(found.matrix - true.matrix).max() < 0.6
    assert np.array_equal(found.rotation, true.rotation)


def test_takes_of_one_rig_get_one_correction_and_mismatches_are_refused() -> None:
    true = rig()
    mattes = figure(true)
    found = refine_calibration({"t": mattes, "u": mattes}, {"t": true, "u": true}, sweeps=1, frames=2)
    assert np.array_equal(found["t"].matrix, found["u"].matrix)
    fewer = Cameras(*(field[:5] for field in true))
    with pytest.raises(ValueError, match="6 pictures and 5 cameras"):
        refine_calibration({"t": mattes}, {"t": fewer})
