import numpy as np

from reperform.nodes.kernels.camera import look_at
from reperform.nodes.kernels.plane_sweep import sweep_cost
from reperform.nodes.kernels.voxel_carving import camera_rows

HEIGHT, WIDTH, DEPTH = 160, 200, 0.03
NORMAL = np.array([0.1, 0.2, 1.0]) / np.linalg.norm([0.1, 0.2, 1.0])
PLACE = np.array([0.05, 0.02, -0.01])


def filmed(contrast: float) -> tuple[np.ndarray, np.ndarray]:
    """A painted plane through PLACE - DEPTH normal, seen by three cameras of different gains."""
    images, rig = [], []
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    for k, eye in enumerate(([-0.8, 0.3, 1.9], [0.0, 0.5, 2.2], [0.9, 0.1, 1.8])):
        rotation, translation = look_at(np.array(eye), PLACE + [0.02, 0.01, 0])
        matrix = np.array([[400.0, 0, 103], [0, 396, 78], [0, 0, 1]])
        rays = np.stack([x, y, np.ones_like(x)], axis=-1) @ np.linalg.inv(matrix).T @ rotation
        reach = ((PLACE - DEPTH * NORMAL - eye) @ NORMAL) / (rays @ NORMAL)
        at = np.array(eye) + reach[..., None] * rays
        wave = [
            np.sin(90 * at[..., 0] + 40 * at[..., 1] ** 2 * 9),
            np.cos(110 * at[..., 1] + 20 * at[..., 0]),
        ]
        colour = 120 + contrast * np.stack([wave[0], wave[1], wave[0] * wave[1]], axis=-1)
        images.append(np.dstack([(0.7 + 0.2 * k) * colour, np.full(x.shape, 255.0)]))
        rig.append((matrix, rotation, translation, np.zeros(5)))
    return np.stack(images).astype(np.float32), camera_rows(
        *(np.stack(part) for part in zip(*rig, strict=True))
    )


def swept(contrast: float, views: list[int], least_alpha: float = 255) -> tuple[np.ndarray, np.ndarray]:
    images, rows = filmed(contrast)
    images[..., 3] = least_alpha
    depths = np.arange(-0.02, 0.081, 0.005)
    points = PLACE + np.array([[0, 0, 0], [0.02, -0.03, 0]])
    points = points - ((points - PLACE) @ NORMAL)[:, None] * NORMAL
    cost = sweep_cost(images, rows, points, np.tile(NORMAL, (2, 1)), np.array([views] * 2), depths, 0.01, 2)
    return depths, cost


def test_the_cost_is_least_at_the_plane_whatever_the_gains() -> None:
    depths, cost = swept(60.0, [0, 1, 2])
    assert np.allclose(depths[cost.argmin(axis=1)], DEPTH)
    assert (cost.min(axis=1) < 0.03).all()
    assert (np.sort(cost, axis=1)[:, 3] > 0.05).all()


def test_without_texture_or_a_second_camera_or_a_matte_nothing_is_said() -> None:
    assert (swept(0.0, [0, 1, 2])[1] > 0.99).all()
    assert (swept(60.0, [1, -1, -1])[1] == 1).all()
    assert (swept(60.0, [0, 1, 2], 100)[1] == 1).all()
