"""Shorter edges for the same surface."""

from __future__ import annotations

import numpy as np

_ROUNDS = 8


def split_long_edges(
    vertices: np.ndarray, faces: np.ndarray, longest: float
) -> tuple[np.ndarray, np.ndarray]:
    """The same surface with every edge at most `longest` (m), by halving longer ones again and again.

    vertices (V, 3), faces (F, 3) -> the old vertices and new ones behind them; watertight meshes stay so, since
    both faces of an edge halve it. A face with one, two or three halved edges becomes two, three or four. Edges
    over 256 times too long stay longer.
    """
    for _ in range(_ROUNDS):
        pairs = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
        keys, which = np.unique(
            pairs[:, 0].astype(np.int64) * len(vertices) + pairs[:, 1], return_inverse=True
        )
        first, second = vertices[keys // len(vertices)], vertices[keys % len(vertices)]
        long = np.linalg.norm(first - second, axis=1) > longest
        if not long.any():
            break
        middle = np.full(len(keys), -1)
        middle[long] = len(vertices) + np.arange(long.sum())
        vertices = np.concatenate([vertices, 0.5 * (first[long] + second[long])])
        faces = _halved(faces, middle[which].reshape(3, -1).T).astype(np.int32)
    return vertices, faces


def _halved(faces: np.ndarray, middle: np.ndarray) -> np.ndarray:
    """Faces (F, 3) with the new vertex, or -1, of their edges 01, 12, 20 (F, 3)."""
    halved = middle >= 0
    count = halved.sum(axis=1)
    parts = [faces[count == 0]]
    for k in range(3):
        one = (count == 1) & halved[:, k]
        a, b, c = (faces[one, (k + i) % 3] for i in range(3))
        m = middle[one, k]
        parts += [np.stack([a, m, c], axis=1), np.stack([m, b, c], axis=1)]
        two = (count == 2) & ~halved[:, (k + 2) % 3]
        a, b, c = (faces[two, (k + i) % 3] for i in range(3))
        m, n = middle[two, k], middle[two, (k + 1) % 3]
        parts += [np.stack(corner, axis=1) for corner in ([m, b, n], [a, m, n], [a, n, c])]
    every = count == 3
    a, b, c = faces[every].T
    m, n, o = middle[every].T
    parts += [np.stack(corner, axis=1) for corner in ([a, m, o], [m, b, n], [o, n, c], [m, n, o])]
    return np.concatenate(parts)
