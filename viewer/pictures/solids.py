"""Small solids to draw things with: balls at joints, tapered tubes for bones."""

from __future__ import annotations

import numpy as np

SIDES = 10


def tube(start: np.ndarray, end: np.ndarray, thick: float, thin: float) -> tuple[np.ndarray, np.ndarray]:
    """An open tapered tube from start (3,) to end (3,), radii in metres: vertices and faces."""
    along = np.asarray(end, np.float64) - start
    length = float(np.linalg.norm(along))
    along = along / length if length > 1e-9 else np.array([0.0, 1.0, 0.0])
    side = np.cross(along, [0.0, 0.0, 1.0] if abs(along[2]) < 0.9 else [1.0, 0.0, 0.0])
    side /= np.linalg.norm(side)
    other = np.cross(along, side)
    turn = 2 * np.pi * np.arange(SIDES) / SIDES
    ring = np.cos(turn)[:, None] * side + np.sin(turn)[:, None] * other
    vertices = np.concatenate([start + thick * ring, end + thin * ring])
    a = np.arange(SIDES)
    b = (a + 1) % SIDES
    faces = np.concatenate([np.stack([a, b, a + SIDES], 1), np.stack([b, b + SIDES, a + SIDES], 1)])
    return vertices, faces.astype(np.int32)


def ball(centre: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """A ball of 12 x 6 facets: vertices and faces."""
    turn, tilt = np.meshgrid(2 * np.pi * np.arange(12) / 12, np.pi * (np.arange(5) + 1) / 6)
    shell = np.stack([np.sin(tilt) * np.cos(turn), np.cos(tilt), np.sin(tilt) * np.sin(turn)], -1).reshape(
        -1, 3
    )
    vertices = centre + radius * np.concatenate([shell, [[0, 1, 0], [0, -1, 0]]])
    faces = []
    for j in range(12):
        k = (j + 1) % 12
        faces += [[60, k, j], [61, 48 + j, 48 + k]]
        for i in range(4):
            faces += [
                [12 * i + j, 12 * i + k, 12 * i + 12 + j],
                [12 * i + k, 12 * i + 12 + k, 12 * i + 12 + j],
            ]
    return vertices, np.array(faces, np.int32)


def joined(parts: list[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
    """Several meshes as one."""
    if not parts:
        return np.zeros((0, 3)), np.zeros((0, 3), np.int32)
    starts = np.cumsum([0, *[len(vertices) for vertices, _ in parts[:-1]]])
    faces = [faces + start for (_, faces), start in zip(parts, starts, strict=True)]
    return np.concatenate([vertices for vertices, _ in parts]), np.concatenate(faces).astype(np.int32)
