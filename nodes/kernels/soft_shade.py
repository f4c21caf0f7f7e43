"""Soft light on a surface: sky, key light with its own shadow, and a rim."""

from __future__ import annotations

import numpy as np

from reperform.nodes.kernels.camera import look_at
from reperform.nodes.kernels.rasterise import rasterise


def soft_shade(
    points: np.ndarray,
    normals: np.ndarray,
    towards: np.ndarray,
    albedo: np.ndarray,
    vertices: np.ndarray,
    faces: np.ndarray,
    light: np.ndarray,
) -> np.ndarray:
    """Lit colours (P, 3), 0..255, of points (P, 3) with unit normals, seen along unit `towards`.

    colour = albedo (0.36 + 0.14 n_y + 0.42 lit max(0, n . l) + 0.30 n . v + 0.10 (1 - n . v)^3); lit is the share of nine
    samples around the point in the light's depth map that nothing stands in front of. vertices (V, 3) m,
    faces: what casts the shadow; light (3,): direction towards the light.
    """
    aim = light / np.linalg.norm(light)
    key = np.maximum(normals @ aim, 0) * _lit(points, normals, vertices, faces, aim)
    frontal = np.clip(np.einsum("pk,pk->p", normals, towards), 0, 1)
    strength = 0.36 + 0.14 * normals[:, 1] + 0.42 * key + 0.30 * frontal + 0.10 * (1 - frontal) ** 3
    return np.clip(albedo * strength[:, None], 0, 255)


def _lit(
    points: np.ndarray, normals: np.ndarray, vertices: np.ndarray, faces: np.ndarray, aim: np.ndarray
) -> np.ndarray:
    cell, bias = 0.01, 0.02
    rotation, _ = look_at(aim, np.zeros(3))
    seen = vertices @ rotation.T
    low = seen.min(axis=0) - (2 * cell, 2 * cell, 1.0)
    size = np.ceil((seen.max(axis=0)[:2] - low[:2]) / cell).astype(int) + 3
    _, _, depth = rasterise(
        (seen[:, :2] - low[:2]) / cell, seen[:, 2] - low[2], faces, int(size[1]), int(size[0])
    )
    lifted = (points + bias * normals) @ rotation.T - low
    column, row = lifted[:, 0] / cell, lifted[:, 1] / cell
    total = np.zeros(len(points))
    for dx in (-1.2, 0.0, 1.2):
        for dy in (-1.2, 0.0, 1.2):
            x = np.rint(column + dx).astype(int).clip(0, depth.shape[1] - 1)
            y = np.rint(row + dy).astype(int).clip(0, depth.shape[0] - 1)
            total += lifted[:, 2] <= depth[y, x] + bias
    return total / 9
