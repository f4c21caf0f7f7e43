"""The hull's volume against a count of every voxel, and against the solid inside it."""

import itertools

import numpy as np
import pytest

from reperform.nodes.kernels.camera import look_at, project
from reperform.nodes.kernels.matte_hull_volume import matte_hull_volume

CENTRE, RADII = np.array([0.13, 0.52, -0.21]), np.array([0.31, 0.47, 0.22])
EYES = ((2.6, 1.4, 0.3), (-0.4, 1.9, 2.8), (-2.2, 0.9, -1.1), (1.2, 1.1, -2.5))


def ellipsoid_seen(size, lens) -> tuple[np.ndarray, tuple]:
    """Mattes (camera, y, x) of the ellipsoid by ray and solid, and the cameras."""
    matrix = np.array(
        [[1.4 * size[0], 0, size[0] / 2 - 3.3], [0, 1.4 * size[0], size[1] / 2 + 2.2], [0, 0, 1]]
    )
    poses = [look_at(np.array(eye), CENTRE + 0.05) for eye in EYES]
    rig = (
        np.stack([matrix] * len(EYES)),
        np.stack([rotation for rotation, _ in poses]),
        np.stack([translation for _, translation in poses]),
        np.tile(lens, (len(EYES), 1)),
    )
    surface = np.random.default_rng(3).standard_normal((40000, 3))
    surface = CENTRE + RADII * surface / np.linalg.norm(surface, axis=1)[:, None]
    import cv2

    alpha = np.zeros((len(EYES), size[1], size[0]), np.uint8)
    for picture, *camera in zip(alpha, *rig, strict=True):
        outline = cv2.convexHull(project(surface, *camera)[0].astype(np.float32)).astype(np.int32)
        cv2.fillConvexPoly(picture, outline, 255)
    return alpha, rig


def counted(alpha, rig, low, high, voxel, views) -> float:
    """Every voxel of the grid in turn."""
    edge = 32 * voxel
    counts = 32 * np.maximum(np.ceil((high - low) / edge).astype(int), 1)
    grid = np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), -1).reshape(-1, 3)
    points = low + voxel * (grid + 0.5)
    seen, inside = np.zeros(len(points), int), np.ones(len(points), bool)
    height, width = alpha.shape[1:]
    for picture, *camera in zip(alpha, *rig, strict=True):
        x, y = np.nan_to_num(project(points, *camera)[0], nan=-9e5).T
        sees = (x > -0.5) & (y > -0.5) & (x < width - 0.5) & (y < height - 0.5)
        padded = np.pad(picture.astype(float), 1, mode="edge")
        i, j = np.floor(y[sees]).astype(int), np.floor(x[sees]).astype(int)
        v, u = y[sees] - i, x[sees] - j
        value = sum(
            padded[i + 1 + a, j + 1 + b] * (v if a else 1 - v) * (u if b else 1 - u)
            for a, b in itertools.product((0, 1), repeat=2)
        )
        inside[sees] &= value >= 127.5
        seen[sees] += 1
    return float((inside & (seen >= views)).sum() * voxel**3)


@pytest.mark.parametrize("lens", [np.zeros(5), np.array([-0.21, 0.06, 0.004, -0.003, 0.01])])
def test_it_is_the_count_of_all_voxels(lens):
    alpha, rig = ellipsoid_seen((180, 130), lens)
    low, high = CENTRE - RADII - 0.2, CENTRE + RADII + 0.25
    found = matte_hull_volume(alpha, rig, low, high, 0.014, 3)
    assert found == pytest.approx(counted(alpha, rig, low, high, 0.014, 3), abs=3 * 0.014**3)


def test_a_hull_holds_the_solid_and_shrinks_with_every_camera():
    alpha, rig = ellipsoid_seen((420, 310), np.zeros(5))
    low, high = CENTRE - RADII - 0.3, CENTRE + RADII + 0.3
    volumes = [
        matte_hull_volume(alpha[:k], tuple(part[:k] for part in rig), low, high, 0.005, k) for k in (2, 3, 4)
    ]
    solid = 4 / 3 * np.pi * RADII.prod()
    assert volumes[0] > volumes[1] > volumes[2] > solid
    assert volumes[2] < 1.25 * solid


def test_cameras_that_do_not_see_a_place_do_not_empty_it():
    alpha, rig = ellipsoid_seen((180, 130), np.zeros(5))
    away = [part.copy() for part in rig]
    away[1][3], away[2][3] = look_at(np.array(EYES[3]), np.array([9.0, 0.4, -9.0]))
    low, high = CENTRE - RADII - 0.2, CENTRE + RADII + 0.2
    three = tuple(part[:3] for part in rig)
    blind = matte_hull_volume(
        np.where(np.arange(4)[:, None, None] == 3, 0, alpha), tuple(away), low, high, 0.01, 3
    )
    assert blind == pytest.approx(matte_hull_volume(alpha[:3], three, low, high, 0.01, 3))
    assert matte_hull_volume(alpha, tuple(away), low, high, 0.01, 4) == 0
