"""Dual-quaternion skinning: a surface that follows its bones without losing volume at the joints."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation


def dual_quaternions(rotation: np.ndarray, translation: np.ndarray) -> np.ndarray:
    """Unit dual quaternions (..., 8) (real w x y z, dual w x y z) of x -> R x + t."""
    shape = rotation.shape[:-2]
    real = Rotation.from_matrix(rotation.reshape(-1, 3, 3)).as_quat()[:, [3, 0, 1, 2]].reshape(*shape, 4)
    w, vector = real[..., :1], real[..., 1:]
    dual_w = -0.5 * (translation * vector).sum(-1, keepdims=True)
    dual_v = 0.5 * (translation * w + np.cross(translation, vector))
    return np.concatenate([real, dual_w, dual_v], axis=-1)


def skin_dual_quaternion(
    vertices: np.ndarray, weights: np.ndarray, rotation: np.ndarray, translation: np.ndarray
) -> np.ndarray:
    """Posed vertices (T, V, 3) float32 from rest vertices (V, 3), weights (V, B) with rows that sum to 1,
    and bone motions rest -> posed, rotation (T, B, 3, 3) and translation (T, B, 3).

    Q = sum_b w_b q_b / |.|; v' = R(Q) v + t(Q); every q_b is taken on the hemisphere of the first bone's.

    Source: Kavan, Collins, Zara, O'Sullivan 2008, ACM TOG, "Geometric skinning with approximate dual
    quaternion blending".
    """
    motion = dual_quaternions(rotation, translation)
    sign = np.where((motion[..., :4] * motion[:, :1, :4]).sum(-1, keepdims=True) < 0, -1.0, 1.0)
    blended = np.asarray(weights, np.float32) @ (motion * sign).astype(np.float32)
    blended /= np.linalg.norm(blended[..., :4], axis=-1, keepdims=True)
    w, vector = blended[..., :1], blended[..., 1:4]
    dual_w, dual_v = blended[..., 4:5], blended[..., 5:]
    points = np.broadcast_to(np.asarray(vertices, np.float32), (*vector.shape[:-1], 3))
    turned = points + 2 * np.cross(vector, np.cross(vector, points) + w * points)
    return turned + 2 * (w * dual_v - dual_w * vector + np.cross(vector, dual_v))


def skin_linear(
    vertices: np.ndarray, weights: np.ndarray, rotation: np.ndarray, translation: np.ndarray
) -> np.ndarray:
    """Linear blend skinning: v' = sum_b w_b (R_b v + t_b); shapes as `skin_dual_quaternion`."""
    weights = np.asarray(weights, np.float32)
    moved = np.empty((len(rotation), len(vertices), 3), np.float32)
    for frame in range(len(rotation)):
        matrix = np.concatenate([rotation[frame], translation[frame][..., None]], axis=-1).astype(np.float32)
        blended = (weights @ matrix.reshape(len(matrix), 12)).reshape(-1, 3, 4)
        moved[frame] = np.einsum("vij,vj->vi", blended[..., :3], vertices) + blended[..., 3]
    return moved
