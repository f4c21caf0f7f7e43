"""Scenes: a body that walks, turns and hops by known parameters."""

from collections.abc import Callable

import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.performance import Contacts

RINGS, SIDES, FPS = 7, 6, 25.0


def tube() -> tuple[np.ndarray, np.ndarray]:
    """Closed tube (V, 3) about 1.7 m high, wider ahead than behind, and its faces."""
    angle = 2 * np.pi * np.arange(SIDES) / SIDES
    radius = 0.2 + 0.08 * np.cos(angle - 0.4)
    rings = [
        np.column_stack(
            [0.7 * radius * np.sin(angle), np.full(SIDES, 1.7 * k / (RINGS - 1)), radius * np.cos(angle)]
        )
        for k in range(RINGS)
    ]
    points = np.concatenate([*rings, [[0, 0, 0], [0, 1.7, 0.03]]])
    faces = []
    for k in range(RINGS - 1):
        for i in range(SIDES):
            a, b = k * SIDES + i, k * SIDES + (i + 1) % SIDES
            faces += [[a, b, a + SIDES], [b, b + SIDES, a + SIDES]]
    low, high, last = len(points) - 2, len(points) - 1, (RINGS - 1) * SIDES
    for i in range(SIDES):
        faces += [[low, (i + 1) % SIDES, i], [high, last + i, last + (i + 1) % SIDES]]
    return points, np.array(faces, np.int32)


def walker(
    speed: float,
    turn: float = 0.0,
    seconds: float = 2.6,
    heading: float = 0.0,
    at: tuple[float, float] = (0.0, 0.0),
) -> tuple[MeshSequence, Contacts]:
    """A cycle of 1.3 - 0.3 speed s; the left foot is down in its first 0.62, the right half a cycle later."""
    rest, faces = tube()
    time = np.arange(round(seconds * FPS)) / FPS
    phase = time / (1.3 - 0.3 * speed)
    swing = 0.25 * speed * np.sin(2 * np.pi * phase)[:, None]
    points = np.repeat(rest[None], len(time), axis=0)
    points[..., 2] += swing * (rest[:, 1] - 0.85) * np.sign(rest[:, 0] + 0.02)
    points[..., 1] += 0.02 * np.cos(4 * np.pi * phase)[:, None]
    yaw = heading + turn * time
    step = speed / FPS * np.column_stack([np.sin(yaw + 0.5 * turn / FPS), np.cos(yaw + 0.5 * turn / FPS)])
    track = np.cumsum(np.concatenate([[at], step[:-1]]), axis=0)
    placed = np.stack(
        [apply(p, Placement(float(a), xz)) for p, a, xz in zip(points, yaw, track, strict=True)]
    )
    planted = np.column_stack([phase % 1 < 0.62, (phase + 0.5) % 1 < 0.62])
    return MeshSequence(placed.astype(np.float32), faces, np.asarray(FPS, np.float32)), Contacts(planted)


def hopper(height: float, seconds: float = 1.4) -> tuple[MeshSequence, Contacts]:
    """Off the ground in the middle third, `height` up; leaves later the higher it goes."""
    rest, faces = tube()
    time = np.arange(round(seconds * FPS)) / FPS / seconds
    off = 0.32 + 0.2 * height
    flight = np.clip((time - off) / 0.33, 0, 1)
    points = np.repeat(rest[None], len(time), axis=0)
    points[..., 1] += height * 4 * (flight * (1 - flight))[:, None]
    points[..., 2] += 0.1 * np.sin(np.pi * np.clip(time / off, 0, 1))[:, None] * rest[:, 1]
    planted = np.repeat(((flight <= 0) | (flight >= 1))[:, None], 2, axis=1)
    return MeshSequence(points.astype(np.float32), faces, np.asarray(FPS, np.float32)), Contacts(planted)


Takes = tuple[dict[str, MeshSequence], dict[str, Contacts]]


def together(takes: dict[str, tuple[MeshSequence, Contacts]]) -> Takes:
    return {name: mesh for name, (mesh, _) in takes.items()}, {
        name: feet for name, (_, feet) in takes.items()
    }


@pytest.fixture(scope="session")
def takes() -> Takes:
    return together(
        {
            "slow": walker(0.7, heading=0.4, at=(1.0, -2.0)),
            "fast": walker(1.5, heading=-1.1),
            "left": walker(1.1, turn=0.8, at=(3.0, 0.0)),
            "right": walker(1.1, turn=-0.5, heading=2.5),
            "low": hopper(0.2),
            "high": hopper(0.55),
        }
    )


@pytest.fixture(scope="session")
def walk() -> Callable[..., tuple[MeshSequence, Contacts]]:
    return walker
