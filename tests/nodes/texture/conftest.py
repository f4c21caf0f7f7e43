"""A painted solid before a green screen, filmed by six cameras whose lenses distort; the truth has a
formula."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.camera import look_at, project
from reperform.nodes.kernels.rasterise import interpolate
from reperform.nodes.kernels.surface_hits import surface_hits
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.footage import Footage, Mattes
from reperform.nodes.products.mesh import MeshSequence

FPS = np.float32(25)
GREEN = np.array([20.0, 200.0, 40.0])
WIDTH, HEIGHT = 300, 260


def paint(rest: np.ndarray) -> np.ndarray:
    """Colour of a point of the solid at rest; never green."""
    x, y, z = rest.T
    red = 140 + 70 * np.sin(9 * x + 4 * y)
    blue = 140 + 70 * np.cos(11 * y - 6 * z + 1)
    return np.stack([red, 0.5 * red, blue], axis=1)


class Scene(NamedTuple):
    rest: np.ndarray
    mesh: MeshSequence
    cameras: Cameras
    footage: Footage
    mattes: Mattes
    truth: Callable[..., tuple[np.ndarray, np.ndarray]]


def film(rest, vertices, faces, pose, height=HEIGHT, width=WIDTH, background=GREEN):
    hits = surface_hits(*project(vertices, *pose), faces, height, width, 3)
    colour = paint(interpolate(rest, faces, hits.ids, hits.barycentric))
    picture = np.broadcast_to(np.asarray(background, float), (height, width, 3)).copy()
    picture[hits.y, hits.x] += hits.coverage[:, None] * (colour - picture[hits.y, hits.x])
    alpha = np.zeros((height, width), np.uint8)
    alpha[hits.y, hits.x] = np.rint(255 * hits.coverage)
    return np.rint(picture).astype(np.uint8), alpha


@pytest.fixture(scope="session")
def scene() -> Scene:
    """A standing ellipsoid of three radii with an arm beside it, off centre, in two frames."""
    body, arm = trimesh.creation.icosphere(subdivisions=4), trimesh.creation.icosphere(subdivisions=3)
    rest = np.concatenate(
        [body.vertices * (0.28, 0.8, 0.19), arm.vertices * (0.07, 0.35, 0.06) + (0.42, 0.2, 0.02)]
    )
    faces = np.concatenate([body.faces, arm.faces + len(body.vertices)]).astype(np.int32)
    placed = rest + (0.3, 0.85, -0.2)
    frames = np.stack([placed, placed * (1, 1.05, 1) + (0.08, 0, 0.05)]).astype(np.float32)
    middle = np.array([0.3, 0.85, -0.2])
    poses = [
        look_at(middle + (2.6 * np.sin(a), 0.5 + 0.1 * k, 2.6 * np.cos(a)), middle)
        for k, a in enumerate(np.radians([10, 65, 130, 190, 250, 305]))
    ]
    matrix = np.array([[330.0, 0, 152.0], [0, 326.0, 127.0], [0, 0, 1]])
    distortion = np.array([-0.22, 0.06, 0.001, -0.002, 0.0])
    count = len(poses)
    cameras = Cameras(
        np.repeat(matrix[None], count, 0),
        np.stack([r for r, _ in poses]),
        np.stack([t for _, t in poses]),
        np.repeat(distortion[None], count, 0),
        np.tile(np.int32([WIDTH, HEIGHT]), (count, 1)),
        np.array([f"c{k}" for k in range(count)]),
    )
    shots = [[film(rest, v, faces, (matrix, r, t, distortion)) for r, t in poses] for v in frames]
    images = np.array([[picture for picture, _ in row] for row in shots])
    alpha = np.array([[matte for _, matte in row] for row in shots])

    def truth(vertices, pose, height, width, background):
        return film(rest, vertices, faces, pose, height, width, background)

    return Scene(
        rest, MeshSequence(frames, faces, FPS), cameras, Footage(images, FPS), Mattes(alpha, FPS), truth
    )
