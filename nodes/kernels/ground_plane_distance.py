"""Distances between all pairs of frames, least over the ground-plane motions of one of them."""

from __future__ import annotations

from typing import Literal

import numpy as np

Motion = Literal["yaw_and_offset", "offset", "none"]


def ground_plane_distance(
    points_a: np.ndarray,
    points_b: np.ndarray,
    vectors_a: np.ndarray,
    vectors_b: np.ndarray,
    vector_weight: float,
    motion: Motion = "yaw_and_offset",
    weights: np.ndarray | None = None,
) -> np.ndarray:
    """Root mean square distance of every frame of a (Ta, N, 3) from every frame of b (Tb, N, 3): (Ta, Tb)
    float64.

    d^2 = min over (yaw, x, z) of mean_i |a_i - R b_i - t|^2 + vector_weight mean_i |u_i - R v_i|^2, where the
    vectors u, v (velocities) turn with the points but do not shift. With centred x, z and
    C = sum a_x b_x + a_z b_z, S = sum a_x b_z - a_z b_x the best turn gives sqrt(C^2 + S^2) in place of C.
    With weights (N,) the means are weighted ones.
    """
    count = points_a.shape[1] if weights is None else float(weights.sum())
    a, b = _centred(points_a, motion, weights), _centred(points_b, motion, weights)
    dot, cross, height = pair_products(a, b)
    square = (a**2).sum(axis=(1, 2))[:, None] + (b**2).sum(axis=(1, 2))[None, :]
    if vector_weight > 0:
        u, v = _weighted(vectors_a, weights), _weighted(vectors_b, weights)
        more_dot, more_cross, more_height = pair_products(u, v)
        dot += vector_weight * more_dot
        cross += vector_weight * more_cross
        height += vector_weight * more_height
        square += vector_weight * ((u**2).sum(axis=(1, 2))[:, None] + (v**2).sum(axis=(1, 2))[None, :])
    best = np.hypot(dot, cross) if motion == "yaw_and_offset" else dot
    return np.sqrt(np.maximum(square - 2 * (best + height), 0) / count)


def _centred(points: np.ndarray, motion: Motion, weights: np.ndarray | None) -> np.ndarray:
    centred = points.astype(np.float64)
    if motion != "none" and weights is None:
        centred[:, :, ::2] -= centred[:, :, ::2].mean(axis=1, keepdims=True)
    elif motion != "none" and weights is not None:
        centred[:, :, ::2] -= np.einsum("n,tnk->tk", weights / weights.sum(), centred[:, :, ::2])[:, None]
    return _weighted(centred, weights)


def _weighted(vectors: np.ndarray, weights: np.ndarray | None) -> np.ndarray:
    """Vectors (T, N, 3) scaled so that sums of their products are weighted sums."""
    scaled = vectors.astype(np.float64)
    return scaled if weights is None else scaled * np.sqrt(weights)[:, None]


def pair_products(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Sums over points of every frame of a with every frame of b, each (Ta, Tb): a_x b_x + a_z b_z,
    a_x b_z - a_z b_x, and a_y b_y.
    """
    ax, ay, az = (np.ascontiguousarray(a[:, :, k]) for k in range(3))
    bx, by, bz = (np.ascontiguousarray(b[:, :, k]).T for k in range(3))
    return ax @ bx + az @ bz, ax @ bz - az @ bx, ay @ by


def velocity(points: np.ndarray) -> np.ndarray:
    """Motion per frame (T, N, 3), the step that leads to each frame; the first takes that of the second."""
    if len(points) < 2:
        return np.zeros_like(points)
    steps = np.diff(points, axis=0)
    return np.concatenate([steps[:1], steps])
