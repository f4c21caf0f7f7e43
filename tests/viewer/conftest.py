"""Small products of every kind, without symmetry, and a browser over them."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from reperform.nodes.motion_graph.prune import prune
from reperform.nodes.product import product_fields
from reperform.nodes.products.cameras import CameraPath, Cameras
from reperform.nodes.products.footage import CleanPlate, Film, Footage, Mattes
from reperform.nodes.products.key_frame_table import KeyFrameTable
from reperform.nodes.products.measure_comparison import MeasureComparison
from reperform.nodes.products.mesh import MeshSequence, Occupancy, Surfaces, TextureAtlas
from reperform.nodes.products.mocap import Mocap, SkeletalAnimation
from reperform.nodes.products.motion import Dissimilarity, MotionGraph, MotionPath, Provenance, ShapeTree
from reperform.nodes.products.performance import BoneRotations, Contacts, Performance, SkeletonSequence
from reperform.nodes.products.table import Table
from reperform.nodes.products.target_grid import TargetGrid
from reperform.nodes.ragged import Ragged

FPS = np.float32(25.0)


@pytest.fixture
def display() -> Iterator[str]:
    """A virtual screen of this test's own."""
    server = shutil.which("Xvfb")
    if server is None:
        pytest.skip("Xvfb is not installed: apt-get install xvfb")
    read, write = os.pipe()
    command = [server, "-displayfd", str(write), "-screen", "0", "800x600x24", "-nolisten", "tcp", "-noreset"]
    with subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL) as screen:
        os.close(write)
        with os.fdopen(read) as pipe:
            number = pipe.readline().strip()
        yield f":{number}"
        screen.terminate()


def filled(kind: type, lengths: dict[str, int], **given: Any) -> Any:
    """A product with the given fields and zeros in those that this test does not care about."""
    values = dict(given)
    for name, axes in product_fields(kind).items():
        if "." not in name and name not in values:
            shape = [int(axis) if axis.isdigit() else lengths[axis] for axis in axes.names]
            values[name] = np.zeros(shape, axes.dtype)
    return kind(**values)


def blob(
    stretch: tuple[float, float, float], rows: int = 14, columns: int = 22
) -> tuple[np.ndarray, np.ndarray]:
    """A closed ellipsoid with its lower end on the ground and three different radii."""
    tilt = np.pi * (np.arange(rows) + 1) / (rows + 1)
    turn = 2 * np.pi * np.arange(columns) / columns
    ring = np.stack(
        [
            np.sin(tilt)[:, None] * np.cos(turn),
            np.repeat(np.cos(tilt)[:, None], columns, 1),
            -np.sin(tilt)[:, None] * np.sin(turn),
        ],
        -1,
    ).reshape(-1, 3)
    vertices = np.concatenate([ring, [[0, 1, 0], [0, -1, 0]]]) * stretch + [0.1, stretch[1], -0.05]
    k, j = np.arange(rows * columns), (np.arange(rows * columns) // columns) * columns
    right = j + (k - j + 1) % columns
    body = k < (rows - 1) * columns
    sides = [
        np.stack([k, k + columns, right], 1)[body],
        np.stack([right, k + columns, right + columns], 1)[body],
    ]
    first, last = np.arange(columns), (rows - 1) * columns + np.arange(columns)
    top = np.stack([np.full(columns, rows * columns), first, (first + 1) % columns], 1)
    bottom = np.stack([np.full(columns, rows * columns + 1), last[0] + (first + 1) % columns, last], 1)
    return vertices.astype(np.float32), np.concatenate([*sides, top, bottom]).astype(np.int32)


def sequence(count: int, speed: float = 0.05, phase: float = 0.0) -> MeshSequence:
    """A bending blob that travels along z."""
    vertices, faces = blob((0.25, 0.9, 0.15))
    frames = []
    for k in range(count):
        bend = 0.25 * np.sin(0.5 * k + phase) * (vertices[:, 1:2] / 1.8) ** 2
        frames.append(vertices + bend * np.array([1.0, 0, 0.3], np.float32) + np.float32([0, 0, speed * k]))
    return MeshSequence(np.stack(frames).astype(np.float32), faces, FPS)


def graph() -> MotionGraph:
    """Three takes with seven transitions, one of them back into its own take."""
    rows = np.array(
        [
            [0, 1, 10, 3, 4],
            [0, 1, 15, 8, 2],
            [1, 2, 20, 5, 6],
            [2, 1, 9, 18, 3],
            [1, 0, 24, 6, 4],
            [1, 1, 22, 2, 3],
            [2, 1, 4, 11, 5],
        ],
        np.int32,
    )
    return filled(
        MotionGraph,
        {"transition": 7},
        takes=np.array(["stand", "stand_to_walk", "walk"]),
        frames=np.array([24, 30, 18], np.int32),
        source=rows[:, 0],
        target=rows[:, 1],
        source_frame=rows[:, 2],
        target_frame=rows[:, 3],
        length=rows[:, 4],
        cost=np.array([0.2, 0.31, 0.05, 0.12, 0.4, 0.22, 0.09], np.float32),
        core=np.array([True, True, True, True, False, True, True]),
        fps=FPS,
    )


def comparison() -> MeasureComparison:
    """Two measures of two takes, with one transition each."""
    distance = np.stack([matrix(30, 30).distance, matrix(30, 30).distance ** 2])
    one = np.int32([0, 1])
    return MeasureComparison(
        np.array(["shape", "skeleton"]), np.array(["walk", "jog"]), np.int32([12, 18]), distance,
        one, one, 1 - one, np.int32([4, 9]), np.int32([6, 3]), np.array([0.1, 0.2]), np.int32(4),
    )  # fmt: skip


def matrix(rows: int, columns: int) -> Dissimilarity:
    """A periodic matrix, as walking makes it."""
    a, b = np.mgrid[:rows, :columns]
    return Dissimilarity((1 - np.cos(2 * np.pi * (a - b + 3) / 13) + 0.02 * a).astype(np.float32))


def path() -> MotionPath:
    """Stand, go over to walking with four blended frames, walk."""
    take = np.array([[0, 1]] * 16 + [[2, 2]] * 20, np.int32)
    source = np.stack([np.r_[0:16, 2:18, 2:6], np.r_[[0] * 12, 3:7, [0] * 20]], 1).astype(np.int32)
    weight = np.zeros((36, 2), np.float32)
    weight[:, 0] = 1
    weight[12:16, 1] = [0.2, 0.4, 0.6, 0.8]
    weight[12:16, 0] -= weight[12:16, 1]
    yaw = np.repeat(np.linspace(0, 0.7, 36)[:, None], 2, 1).astype(np.float32)
    offset = np.repeat(np.linspace(0, 1.5, 36)[:, None, None] * [[0.5, 1.0]], 2, 1).astype(np.float32)
    provenance = Provenance(np.array(["stand", "stand_to_walk", "walk"]), take, source, weight, yaw, offset)
    return filled(
        MotionPath,
        {"step": 1},
        provenance=provenance,
        distance=np.float32([1.98, 2.0]),
        duration=np.float32([1.44, np.nan]),
        cost=np.float32(0.83),
        bound=np.float32(0.81),
        fps=FPS,
    )


def cameras(count: int = 5) -> Cameras:
    """Cameras on an arc of unequal heights that look at the performer."""
    from reperform.nodes.kernels.camera import look_at

    turn = np.linspace(0.2, 4.6, count)
    poses = [
        look_at(np.array([3 * np.sin(t), 1.4 + 0.2 * k, 3.4 * np.cos(t)]), np.array([0.1, 0.9, 0]))
        for k, t in enumerate(turn)
    ]
    matrix = np.array([[300.0, 0, 79.5], [0, 300.0, 44.5], [0, 0, 1]])
    return Cameras(
        np.repeat(matrix[None], count, 0),
        np.stack([rotation for rotation, _ in poses]),
        np.stack([translation for _, translation in poses]),
        np.zeros((count, 5)),
        np.repeat(np.int32([[160, 90]]), count, 0),
        np.array([f"cam{k}" for k in range(count)]),
    )


def target_grid() -> TargetGrid:
    """One sequence, 4 x 6 targets: fast ones cannot be met, one is open, the others are missed a little."""
    distance, duration = np.arange(1.0, 5.0), np.arange(1.0, 7.0)
    status = np.where(distance[:, None] > 0.8 * duration, 0, 1).astype(np.int8)
    status[3, 5] = -1
    error = 0.01 * np.sin(np.arange(24).reshape(4, 6))
    return filled(
        TargetGrid,
        {"transition": 2},
        keys=np.array(["stand:0 > walk:8"]),
        distance=distance,
        duration=duration,
        reached_distance=(distance[:, None] + error)[None],
        reached_duration=(duration + error)[None],
        cost=np.ones((1, 4, 6)),
        bound=np.ones((1, 4, 6)),
        status=status[None],
        taken=np.zeros((1, 4, 6, 2), np.int16),
    )


def key_frame_table() -> KeyFrameTable:
    """Two rows of made-up numbers."""
    numbers = (np.array([0.001 * k, 0.0123 * k]) for k in range(1, len(KeyFrameTable._fields) - 1))
    return KeyFrameTable(np.array(["skirt", "dress"]), np.array(["stand:0 > walk:8"] * 2), *numbers)


def make_products() -> dict[str, Any]:
    """One small product of every kind by name."""
    mesh = sequence(12)
    rng = np.random.default_rng(3)
    images = rng.integers(0, 255, (4, 3, 45, 80, 3), np.uint8)
    alpha = np.zeros((4, 3, 45, 80), np.uint8)
    alpha[:, :, 10:40, 30:55] = 255
    image = np.zeros((64, 32, 3), np.uint8)
    image[:32] = [200, 60, 60]
    image[32:] = [40, 90, 200]
    uv = np.stack([mesh.vertices[0, :, 0] + 0.4, mesh.vertices[0, :, 1] / 1.8], 1).clip(0.01, 0.99)
    atlas = TextureAtlas(uv.astype(np.float32), mesh.faces, image)
    joints = np.array(
        [[0, 0.9, 0], [0, 1.4, 0.02], [0.2, 1.3, 0], [-0.2, 1.3, 0.1], [0.12, 0.05, 0], [-0.12, 0.1, 0.2]]
    )
    skeleton = SkeletonSequence(
        np.stack([joints + [0, 0, 0.05 * k] for k in range(12)]).astype(np.float32),
        np.array([-1, 0, 1, 1, 0, 0], np.int32),
        np.array(["hips", "chest", "hand_l", "RightHand", "lfoot", "foot_r"]),
        FPS,
    )
    mocap = Mocap(skeleton, np.tile(np.eye(3, dtype=np.float32), (12, 6, 1, 1)), joints.astype(np.float32))
    small = blob((0.2, 0.5, 0.3), 8, 10)
    field = np.zeros((12, 20, 9), np.float32)
    field[2:9, 1:17, 2:6] = 0.9
    grown = np.zeros((14, 18, 9), np.float32)
    grown[3:8, 2:15, 1:7] = 0.7
    eye = cameras(6)
    count = len(skeleton.parents)
    bones = BoneRotations(np.tile(np.eye(3, dtype=np.float32), (12, count, 1, 1)), skeleton.parents, FPS)
    return {
        "footage": Footage(images, FPS),
        "plate": CleanPlate(images[0].astype(np.float32), np.full((3, 45, 80, 3), 5, np.float32)),
        "mattes": Mattes(alpha, FPS),
        "film": Film(images[:, 0], alpha[:, 0], FPS),
        "occupancy": Occupancy(
            Ragged([field, grown]), np.float32([[0, 0, 0], [0.1, 0, 0]]), np.float32(0.05), FPS
        ),
        "surfaces": Surfaces(Ragged([mesh.vertices[0], small[0]]), Ragged([mesh.faces, small[1]]), FPS),
        "mesh": mesh,
        "performance": Performance(mesh, atlas, skeleton, Contacts(np.zeros((12, 2), bool)), bones),
        "skeleton": skeleton,
        "mocap": mocap,
        "skeletal_animation": SkeletalAnimation(mocap, path().provenance),
        "cameras": cameras(),
        "orbit": CameraPath(eye.matrix, eye.rotation, eye.translation, np.int32([160, 90])),
        "matrix": matrix(24, 30),
        "comparison": comparison(),
        "graph": graph(),
        "path": path(),
        "tree": ShapeTree(
            np.array(["stand", "walk"]),
            np.int32([0, 0, 0, 1, 1, 1, 1]),
            np.int32([0, 1, 2, 0, 1, 2, 3]),
            np.int32([1, 1, 1, 2, 3, 4, 3]),
            np.float32([0.1, 0, 0.2, 0.5, 0.1, 0.2, 0.1]),
            np.int32([1, 0, 2, 3, 4, 6, 5]),
        ),
        "table": Table(
            np.array(["surface_error_mm", "path_distance_error_m", "heldout_psnr_db", "frames"]),
            np.array([7.314159, 0.061, np.nan, 426.0]),
            np.array(["mm", "m", "dB", "1"]),
            np.array(["<=", "<=", ">=", ""]),
            np.array([12.0, 0.05, 24.0, np.nan]),
            np.int8([1, 0, -1, -1]),
            np.array(["nricp", "", "", ""]),
            np.array([9.8, np.nan, np.nan, np.nan]),
            np.array(["004 fig 2.4", "000 table III", "", ""]),
        ),
        "contacts": Contacts(np.zeros((12, 2), bool)),
        "target_grid": target_grid(),
        "key_frame_table": key_frame_table(),
        "pruned": prune(graph()),
    }


@pytest.fixture(scope="session")
def products() -> dict[str, Any]:
    return make_products()


@pytest.fixture
def walk() -> Callable[..., MeshSequence]:
    return sequence
