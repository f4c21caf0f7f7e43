"""Distances of point clouds that run over a window of frames, least over the ground-plane motions."""

from __future__ import annotations

import numpy as np

from reperform.nodes.kernels.ground_plane_distance import pair_products
from reperform.nodes.kernels.temporal_filter import sum_diagonals


def point_cloud_distance(
    points_a: np.ndarray, points_b: np.ndarray, weights: np.ndarray, window: np.ndarray
) -> np.ndarray:
    """Root mean square distance (Ta, Tb) of the points around every frame of a (Ta, N, 3) and of b (Tb, N, 3).

        d^2(i, j) = min over T of sum_kp w_k v_p |a_p(i + k) - T b_p(j + k)|^2 / sum_kp w_k v_p

    over |k| <= n with i + k and j + k inside; T is one turn about the vertical and shift on the ground for the
    whole window, v (N,) the weights of the points, w (2 n + 1,) those of the frames. In closed form from sums
    along diagonals: with X, Z the weighted sums of both clouds and W that of the weights, the cross terms of the
    centred clouds are sum w x x' - X X' / W, and the best turn gives sqrt(C^2 + S^2).

    Source: Kovar, Gleicher and Pighin 2002, SIGGRAPH, section 3.1.
    """
    a, b = _near_origin(points_a, weights), _near_origin(points_b, weights)
    dot, cross, height = pair_products(a * np.sqrt(weights)[:, None], b * np.sqrt(weights)[:, None])

    def along(matrix: np.ndarray) -> np.ndarray:
        return sum_diagonals(matrix, window)

    shape = dot.shape
    sums_a, sums_b = np.einsum("tnk,n->kt", a, weights), np.einsum("tnk,n->kt", b, weights)
    ax, az = (along(np.broadcast_to(sums_a[k][:, None], shape)) for k in (0, 2))
    bx, bz = (along(np.broadcast_to(sums_b[k][None, :], shape)) for k in (0, 2))
    square_a, square_b = np.einsum("tnk,n->t", a**2, weights), np.einsum("tnk,n->t", b**2, weights)
    mass = along(np.full(shape, weights.sum()))
    square = along(square_a[:, None] + square_b[None, :]) - (ax**2 + az**2 + bx**2 + bz**2) / mass
    turned = np.hypot(along(dot) - (ax * bx + az * bz) / mass, along(cross) - (ax * bz - az * bx) / mass)
    return np.sqrt(np.maximum(square - 2 * (turned + along(height)), 0) / mass)


def _near_origin(points: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """The take shifted on the ground to its own middle, which changes no distance but keeps digits."""
    moved = points.astype(np.float64)
    moved[:, :, ::2] -= np.einsum("tnk,n->k", moved[:, :, ::2], weights) / (weights.sum() * len(moved))
    return moved
