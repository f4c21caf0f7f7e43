"""Closest points of a triangle mesh."""

from __future__ import annotations

from itertools import chain

import numpy as np
from numba import njit
from scipy.spatial import cKDTree


def closest_points(
    points: np.ndarray, vertices: np.ndarray, faces: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The closest point of the mesh to every point (N, 3): face (N,), barycentrics (N, 3) and distance
    (N,), m.

    Exact: all triangles that could hold a point nearer than the nearest corner are tried; ties to the lower
    face.
    Source: the regions of a triangle after Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
    """
    points = np.ascontiguousarray(points, np.float64)
    corners = np.ascontiguousarray(vertices, np.float64)[faces]
    centres = corners.mean(axis=1)
    radius = np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1)
    bound = cKDTree(corners.reshape(-1, 3)).query(points)[0]
    face = np.full(len(points), -1, np.int64)
    barycentric = np.zeros((len(points), 3))
    distance = np.full(len(points), np.inf)
    # triangles in groups of like size, so that one large triangle does not widen every search
    group = np.floor(np.log2(np.maximum(radius, 1e-9))).astype(int)
    for size in np.unique(group):
        members = np.flatnonzero(group == size)
        near = cKDTree(centres[members]).query_ball_point(
            points, bound + radius[members].max() + 1e-9, return_sorted=False
        )
        ends = np.concatenate([[0], np.cumsum([len(found) for found in near])])
        flat = np.fromiter(chain.from_iterable(near), np.int64, ends[-1])
        _try_triangles(points, corners, members, flat, ends, face, barycentric, distance)
    return face, barycentric, distance


@njit(cache=True, nogil=True)
def _try_triangles(
    points: np.ndarray,
    corners: np.ndarray,
    members: np.ndarray,
    candidates: np.ndarray,
    ends: np.ndarray,
    face: np.ndarray,
    barycentric: np.ndarray,
    distance: np.ndarray,
) -> None:
    for i in range(len(points)):
        for k in range(ends[i], ends[i + 1]):
            f = members[candidates[k]]
            u, v, w = _barycentrics(points[i], corners[f, 0], corners[f, 1], corners[f, 2])
            square = 0.0
            for c in range(3):
                square += (
                    u * corners[f, 0, c] + v * corners[f, 1, c] + w * corners[f, 2, c] - points[i, c]
                ) ** 2
            length = np.sqrt(square)
            if length < distance[i] or (length == distance[i] and f < face[i]):
                distance[i] = length
                face[i] = f
                barycentric[i, 0], barycentric[i, 1], barycentric[i, 2] = u, v, w


@njit(cache=True, nogil=True)
def _dot(a: np.ndarray, b: np.ndarray) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(cache=True, nogil=True)
def _barycentrics(p: np.ndarray, a: np.ndarray, b: np.ndarray, c: np.ndarray) -> tuple[float, float, float]:
    ab, ac, ap = b - a, c - a, p - a
    d1, d2 = _dot(ab, ap), _dot(ac, ap)
    if d1 <= 0 and d2 <= 0:
        return 1.0, 0.0, 0.0
    bp = p - b
    d3, d4 = _dot(ab, bp), _dot(ac, bp)
    if d3 >= 0 and d4 <= d3:
        return 0.0, 1.0, 0.0
    vc = d1 * d4 - d3 * d2
    if vc <= 0 and d1 >= 0 and d3 <= 0:
        v = d1 / (d1 - d3)
        return 1 - v, v, 0.0
    cp = p - c
    d5, d6 = _dot(ab, cp), _dot(ac, cp)
    if d6 >= 0 and d5 <= d6:
        return 0.0, 0.0, 1.0
    vb = d5 * d2 - d1 * d6
    if vb <= 0 and d2 >= 0 and d6 <= 0:
        w = d2 / (d2 - d6)
        return 1 - w, 0.0, w
    va = d3 * d6 - d5 * d4
    if va <= 0 and d4 - d3 >= 0 and d5 - d6 >= 0:
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        return 0.0, 1 - w, w
    total = va + vb + vc
    return va / total, vb / total, vc / total
