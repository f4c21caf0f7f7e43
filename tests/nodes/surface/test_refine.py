"""A textured block with a pit in one side that no silhouette shows."""

from functools import cache

import cv2
import numpy as np
import pytest
import trimesh

from reperform.nodes.evaluate.surface_error import surface_error
from reperform.nodes.kernels.camera import look_at, project
from reperform.nodes.kernels.decimate import is_closed
from reperform.nodes.kernels.mesh_geometry import face_cross, volume
from reperform.nodes.kernels.rasterise import interpolate, rasterise
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.footage import Footage, Mattes
from reperform.nodes.products.mesh import MeshSequence, Surfaces
from reperform.nodes.surface.isosurface import isosurface
from reperform.nodes.surface.occupancy import occupancy
from reperform.nodes.surface.refine import refine

FPS = np.float32(25)
WIDTH, HEIGHT = 300, 250
CENTRE = np.array([0.2, 0.8, -0.1])


@cache
def ring(count: int = 8) -> Cameras:
    poses = []
    for k in range(count):
        angle = 2 * np.pi * (k + 0.15 * np.sin(5 * k)) / count
        eye = CENTRE + [2.6 * np.sin(angle), 0.5 + 0.2 * np.cos(3 * k), 2.4 * np.cos(angle)]
        poses.append(look_at(eye, CENTRE + [0.03, 0, -0.02]))
    return Cameras(
        matrix=np.tile(np.array([[520.0, 0, 152], [0, 512, 121], [0, 0, 1]]), (count, 1, 1)),
        rotation=np.stack([pose[0] for pose in poses]),
        translation=np.stack([pose[1] for pose in poses]),
        distortion=np.tile(np.array([-0.1, 0.02, 0.001, 0, 0]), (count, 1)),
        image_size=np.tile(np.array([[WIDTH, HEIGHT]], np.int32), (count, 1)),
        name=np.array([f"c{k}" for k in range(count)]),
    )


@cache
def truth() -> MeshSequence:
    """An ellipsoid, dented by 7 cm in front and behind."""
    ball = trimesh.creation.icosphere(subdivisions=5)
    unit = np.asarray(ball.vertices)
    dents = ((unit - [0.1, 0.1, 0.97]) ** 2).sum(axis=1), ((unit - [-0.7, -0.1, -0.7]) ** 2).sum(axis=1)
    dent = sum(0.07 * np.exp(-square / 0.2) for square in dents)
    points = unit * [0.26, 0.32, 0.22]
    length = np.linalg.norm(points, axis=1, keepdims=True)
    points = points * (1 - dent[:, None] / length) + CENTRE
    return MeshSequence(points.astype(np.float32), np.asarray(ball.faces, np.int32), FPS)


def paint(points: np.ndarray, contrast: float) -> np.ndarray:
    """Bands that are not periodic."""
    x, y, z = ((points - CENTRE) * 40).T
    bands = [
        np.sin(x + 1.7 * y + 0.6 * np.sin(1.3 * z)) + np.sin(2.3 * z - y),
        np.sin(1.9 * y - z) + np.cos(1.5 * x + 0.8 * np.sin(y)),
        np.cos(2.1 * z + 0.4 * x * np.sin(0.3 * y)),
    ]
    return np.clip(128 + contrast * np.stack(bands, axis=1), 0, 255)


@cache
def filmed(contrast: float) -> tuple[Footage, Mattes]:
    mesh, cameras = truth(), ring()
    images, alpha = [], []
    for k in range(len(cameras.name)):
        pixels, depth = project(mesh.vertices, *(part[k] for part in cameras[:4]))
        ids, where, _ = rasterise(3 * pixels + 1, depth, mesh.faces, 3 * HEIGHT, 3 * WIDTH)
        fine = np.full((*ids.shape, 3), 60.0, np.float32)
        hit = ids >= 0
        fine[hit] = paint(interpolate(mesh.vertices, mesh.faces, ids[hit], where[hit]), contrast)
        gain = 1 + 0.2 * np.sin(k + np.arange(3))
        image = gain * cv2.resize(fine, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)
        image += np.random.default_rng(k).normal(0, 1.5, image.shape)
        images.append(np.clip(image, 0, 255).astype(np.uint8))
        cover = cv2.resize(hit.astype(np.float32), (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)
        alpha.append(np.round(255 * cover).astype(np.uint8))
    return Footage(np.stack(images), FPS), Mattes(np.stack(alpha), FPS)


@cache
def hull() -> Surfaces:
    return isosurface(occupancy(filmed(50.0)[1], ring(), voxel=0.012), vertices=1200)


def error(surface: Surfaces) -> np.ndarray:
    return surface_error(truth(), surfaces=surface)[0]


def test_texture_brings_the_surface_into_the_pits() -> None:
    before = error(hull())
    after = error(refine(hull(), *filmed(50.0), ring()))
    assert before[0] > 0.003
    assert (after < 0.35 * before).all()


def test_without_texture_it_stays_the_hull() -> None:
    plain = refine(hull(), *filmed(0.0), ring())
    moved = surface_error(MeshSequence(hull().vertices, hull().faces, FPS), surfaces=plain)[0]
    assert moved[0] < 0.0015
    assert (error(plain) < 1.02 * error(hull())).all()


@pytest.mark.parametrize(("contrast", "vertices"), [(50.0, 0), (50.0, 500), (0.0, 0)])
def test_it_is_closed_and_right_way_round(contrast: float, vertices: int) -> None:
    surface = refine(hull(), *filmed(contrast), ring(), vertices=vertices)
    assert len(surface.vertices) <= (vertices or len(hull().vertices))
    assert is_closed(surface.faces)
    points = surface.vertices.astype(float)
    assert len(surface.faces) == 2 * len(points) - 4
    assert volume(points, surface.faces) > 0
    # seen from the middle, every face of this star-shaped solid turns away
    cross = face_cross(points, surface.faces)
    assert (((points[surface.faces[:, 0]] - CENTRE) * cross).sum(axis=1) > 0).mean() > 0.999


def test_the_same_input_gives_the_same_bits() -> None:
    one, two = (refine(hull(), *filmed(50.0), ring()) for _ in range(2))
    assert np.array_equal(one.vertices, two.vertices)
    assert np.array_equal(one.faces, two.faces)


def test_refuses_pictures_of_another_size() -> None:
    footage, mattes = filmed(50.0)
    with pytest.raises(ValueError, match="refine"):
        refine(hull(), footage._replace(images=footage.images[:, :-2]), mattes, ring())
