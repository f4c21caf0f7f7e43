"""Many characters of one blend space at once, their normals and bounding boxes: no allocation."""

from __future__ import annotations

import numpy as np
from numba import njit

from reperform.nodes.kernels.hybrid_blend import HybridFields, evaluate_between


@njit(cache=True, nogil=True)
def evaluate_crowd(
    fields: HybridFields,
    times: np.ndarray,
    weights: np.ndarray,
    places: np.ndarray,
    out: np.ndarray,
    scratch: np.ndarray,
) -> None:
    """Write K characters into out (K, V, 3) float32, m, each at its own time, weights and place.

    times: (K,) in poses, as `evaluate_between`; weights: (K, N); places: (K, 3) x, z (m) and yaw (rad), which
    take a character's coordinates to the world: R_y(yaw) x + (x, 0, z).
    """
    for k in range(len(out)):
        evaluate_between(fields, times[k], weights[k], out[k], scratch)
        place_on_ground(out[k], places[k, 0], places[k, 1], places[k, 2])


@njit(cache=True, nogil=True)
def place_on_ground(vertices: np.ndarray, x: float, z: float, yaw: float) -> None:
    """Turn vertices (V, 3) float32 about the vertical, then shift them over the ground, in place."""
    c, s = np.float32(np.cos(yaw)), np.float32(np.sin(yaw))
    dx, dz = np.float32(x), np.float32(z)
    for v in range(len(vertices)):
        a, b = vertices[v, 0], vertices[v, 2]
        vertices[v, 0] = c * a + s * b + dx
        vertices[v, 2] = c * b - s * a + dz


@njit(cache=True, nogil=True)
def normals_into(vertices: np.ndarray, faces: np.ndarray, out: np.ndarray) -> None:
    """Write unit normals at vertices into out (V, 3) float32: area-weighted mean of the faces around; 0 if loose."""
    out[:] = 0.0
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        u0, u1, u2 = (
            vertices[b, 0] - vertices[a, 0],
            vertices[b, 1] - vertices[a, 1],
            vertices[b, 2] - vertices[a, 2],
        )
        v0, v1, v2 = (
            vertices[c, 0] - vertices[a, 0],
            vertices[c, 1] - vertices[a, 1],
            vertices[c, 2] - vertices[a, 2],
        )
        n0, n1, n2 = u1 * v2 - u2 * v1, u2 * v0 - u0 * v2, u0 * v1 - u1 * v0
        for w in (a, b, c):
            out[w, 0] += n0
            out[w, 1] += n1
            out[w, 2] += n2
    for v in range(len(out)):
        length = np.sqrt(out[v, 0] ** 2 + out[v, 1] ** 2 + out[v, 2] ** 2)
        if length > 0.0:
            scale = np.float32(1.0 / length)
            for k in range(3):
                out[v, k] *= scale


@njit(cache=True, nogil=True)
def bounds_into(vertices: np.ndarray, out: np.ndarray) -> None:
    """Write the least and greatest coordinates of vertices (V, 3) into out (2, 3), m."""
    for k in range(3):
        out[0, k] = out[1, k] = vertices[0, k]
    for v in range(len(vertices)):
        for k in range(3):
            x = vertices[v, k]
            if x < out[0, k]:
                out[0, k] = x
            elif x > out[1, k]:
                out[1, k] = x
