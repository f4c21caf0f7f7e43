import numpy as np
import pytest

from reperform.nodes.kernels.camera import look_at
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.footage import Mattes
from reperform.nodes.surface.isosurface import isosurface
from reperform.nodes.surface.occupancy import occupancy

FPS = np.float32(25)
CENTRE = np.array([0.4, 0.9, -0.3])
RADII = np.array([0.25, 0.6, 0.18])
WIDTH, HEIGHT = 240, 165


def ring(count: int, distortion: tuple[float, ...] = (0, 0, 0, 0, 0), eye_height: float = 1.8) -> Cameras:
    poses = []
    for k in range(count):
        angle = 2 * np.pi * k / count + 0.3
        eye = CENTRE * [1, 0, 1] + [3.5 * np.sin(angle), eye_height, 3.1 * np.cos(angle)]
        poses.append(look_at(eye, CENTRE + [0.1, -0.05, 0.07]))
    return Cameras(
        matrix=np.tile(np.array([[262.0, 0, 118], [0, 259, 84], [0, 0, 1]]), (count, 1, 1)),
        rotation=np.stack([pose[0] for pose in poses]),
        translation=np.stack([pose[1] for pose in poses]),
        distortion=np.tile(np.array(distortion, np.float64), (count, 1)),
        image_size=np.tile(np.array([[WIDTH, HEIGHT]], np.int32), (count, 1)),
        name=np.array([f"c{k}" for k in range(count)]),
    )


def seen(cameras: Cameras) -> np.ndarray:
    """Exact mattes of the ellipsoid: a ray hits where its discriminant is positive; 3x3 samples per pixel."""
    steps = (np.arange(3) - 1) / 3
    y, x, dy, dx = np.meshgrid(np.arange(HEIGHT), np.arange(WIDTH), steps, steps, indexing="ij")
    pixels = np.stack([x + dx, y + dy], axis=-1).reshape(-1, 2)
    alpha = []
    for k in range(len(cameras.name)):
        lens = (pixels - cameras.matrix[k, :2, 2]) / cameras.matrix[k, [0, 1], [0, 1]]
        ideal = lens.copy()
        k1 = cameras.distortion[k, 0]
        for _ in range(6 if k1 else 0):
            ideal = lens / (1 + k1 * (ideal**2).sum(axis=1, keepdims=True))
        rays = np.column_stack([ideal, np.ones(len(ideal))]) @ cameras.rotation[k] / RADII
        eye = (-cameras.rotation[k].T @ cameras.translation[k] - CENTRE) / RADII
        a, b, c = (rays * rays).sum(axis=1), rays @ eye, eye @ eye - 1
        hit = (b * b - a * c > 0).reshape(HEIGHT, WIDTH, 9)
        alpha.append(np.round(255 * hit.mean(axis=2)).astype(np.uint8))
    return np.stack(alpha)


@pytest.mark.parametrize("distortion", [(0, 0, 0, 0, 0), (-0.25, 0, 0, 0, 0)])
def test_many_cameras_all_round_give_the_ellipsoid(distortion: tuple[float, ...]) -> None:
    low, high = ring(5, distortion, 0.2), ring(6, distortion, 2.6)
    cameras = Cameras(*(np.concatenate(pair) for pair in zip(low, high, strict=True)))
    field = occupancy(Mattes(seen(cameras), FPS), cameras, voxel=0.01)
    surface = isosurface(field, vertices=0, smoothing=0)
    radial = np.linalg.norm((surface.vertices - CENTRE) / RADII, axis=1)
    # outside by what 11 views leave, inside by no more than about half a voxel (of 0.18 m)
    assert radial.min() > 0.965
    assert radial.mean() < 1.05


def test_coarse_voxels_do_not_fatten_the_hull() -> None:
    cameras = ring(6)
    mattes = Mattes(seen(cameras), FPS)
    volumes = [
        float((occupancy(mattes, cameras, voxel=voxel).probability > 0.5).sum() * voxel**3)
        for voxel in (0.02, 0.01, 0.005)
    ]
    assert volumes[0] == pytest.approx(volumes[2], rel=0.02)
    assert volumes[1] == pytest.approx(volumes[2], rel=0.01)


def test_the_box_holds_the_hull_and_little_more() -> None:
    cameras = ring(6)
    field = occupancy(Mattes(seen(cameras), FPS), cameras, voxel=0.01)
    full = np.argwhere(field.probability > 0.5)
    assert full.min() > 0
    assert np.all(full.max(axis=0) < np.array(field.probability.shape) - 1)
    low = field.origin + 0.01 * full.min(axis=0)
    high = field.origin + 0.01 * full.max(axis=0)
    assert np.all(low <= CENTRE - RADII + 0.011)
    assert np.all(high >= CENTRE + RADII - 0.011)
    assert field.probability.size < 12 * len(full)


def test_one_wrong_matte_is_survived_with_one_miss() -> None:
    cameras = ring(8)
    alpha = seen(cameras)
    whole = (occupancy(Mattes(alpha, FPS), cameras, voxel=0.02).probability > 0.5).sum()
    alpha[2, :, : WIDTH // 2 + 5] = 0
    cut = (occupancy(Mattes(alpha, FPS), cameras, voxel=0.02).probability > 0.5).sum()
    saved = (occupancy(Mattes(alpha, FPS), cameras, voxel=0.02, misses=1).probability > 0.5).sum()
    assert cut < 0.8 * whole
    assert saved >= 0.98 * whole


def test_out_of_view_is_unknown_not_empty() -> None:
    cameras = ring(7)
    alpha = seen(cameras)
    whole = (occupancy(Mattes(alpha, FPS), cameras, voxel=0.02).probability > 0.5).sum()
    # camera 3 looks past the upper half of the figure
    shifted = cameras.matrix.copy()
    shifted[3, 1, 2] -= 82
    moved = np.zeros_like(alpha[3])
    moved[:-82] = alpha[3, 82:]
    alpha[3] = moved
    half = (
        occupancy(Mattes(alpha, FPS), cameras._replace(matrix=shifted), voxel=0.02).probability > 0.5
    ).sum()
    assert whole <= half < 1.3 * whole


def test_nothing_is_under_the_floor() -> None:
    cameras = ring(6)
    field = occupancy(Mattes(seen(cameras), FPS), cameras, voxel=0.02, floor=0.5)
    surface = isosurface(field)
    assert surface.vertices[:, 1].min() == pytest.approx(0.5, abs=0.004)


def test_an_empty_matte_is_named_or_allowed() -> None:
    cameras = ring(5)
    alpha = seen(cameras)
    alpha[3] = 0
    with pytest.raises(ValueError, match="matte of camera c3 is empty"):
        occupancy(Mattes(alpha, FPS), cameras)
    assert (occupancy(Mattes(alpha, FPS), cameras, voxel=0.03, misses=1).probability > 0.5).any()


def test_a_calibration_of_another_rig_is_refused() -> None:
    cameras = ring(4)
    alpha = seen(cameras)
    with pytest.raises(ValueError, match="3 pictures and 4 cameras"):
        occupancy(Mattes(alpha[:3], FPS), cameras)
    with pytest.raises(ValueError, match="camera c0 is for pictures of 240x165 px, got 240x150 px"):
        occupancy(Mattes(np.ascontiguousarray(alpha[:, :150]), FPS), cameras)


def test_mattes_without_a_common_volume_are_refused() -> None:
    cameras = ring(4)
    alpha = np.zeros((4, HEIGHT, WIDTH), np.uint8)
    for k in range(4):
        alpha[k, 20:30, 20 + 50 * k : 30 + 50 * k] = 255
    with pytest.raises(ValueError, match="no volume in common"):
        occupancy(Mattes(alpha, FPS), cameras)
