"""Bones as octahedra: closed, and thick enough to be seen."""

from __future__ import annotations

import numpy as np

# parent, four corners, joint
_FACES = np.array(
    [[0, 2, 1], [0, 3, 2], [0, 4, 3], [0, 1, 4], [5, 1, 2], [5, 2, 3], [5, 3, 4], [5, 4, 1]], np.int32
)


def bone_octahedra(
    parents: np.ndarray, joints: np.ndarray, thickness: float, least: float
) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (T, 6 B, 3) and faces (8 B, 3) of bones that go from parents to joints, both (T, B, 3), m.

    The four corners lie at p + s d + max(s l, least) c_k, d the bone, l its length, s the thickness and c_k unit
    vectors across it. From frame to frame c_k is turned by the least rotation that turns the bone.
    """
    bone = joints - parents
    length = np.linalg.norm(bone, axis=-1, keepdims=True)
    direction = bone / np.maximum(length, 1e-12)
    across = _carried(direction)
    side = np.cross(direction, across)
    corners = (
        np.stack([across, side, -across, -side], axis=2) * np.maximum(thickness * length, least)[:, :, None]
    )
    waist = (parents + thickness * bone)[:, :, None] + corners
    vertices = np.concatenate([parents[:, :, None], waist, joints[:, :, None]], axis=2)
    faces = 6 * np.arange(bone.shape[1], dtype=np.int32)[:, None, None] + _FACES
    return vertices.reshape(len(bone), -1, 3), faces.reshape(-1, 3)


def _carried(direction: np.ndarray) -> np.ndarray:
    """Unit vectors (T, B, 3) across the directions; from one, a, to the next, b: x - (b . x) (a + b) / (1 + a . b)."""
    across = np.empty_like(direction)
    # of the axis that a bone is least along, what is across it
    axis = np.eye(3)[np.argmin(np.abs(direction[0]), axis=-1)]
    across[0] = axis - np.sum(axis * direction[0], axis=-1, keepdims=True) * direction[0]
    across[0] /= np.linalg.norm(across[0], axis=-1, keepdims=True)
    for t in range(1, len(direction)):
        a, b, x = direction[t - 1], direction[t], across[t - 1]
        along = np.sum(b * x, axis=-1, keepdims=True) / np.maximum(
            1 + np.sum(a * b, axis=-1, keepdims=True), 1e-9
        )
        across[t] = x - along * (a + b)
    return across
