"""Triangles taken apart into a rotation and a stretch in their own plane, in closed form."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from reperform.nodes.kernels.quaternion import from_matrix

# Below this length (m) an edge, below its square an area, has no direction of its own.
_TINY = 1e-15


class FaceFrames(NamedTuple):
    """The faces of a reference mesh, each in a frame of its own: x along its first edge, z its normal."""

    # columns are the axes, (F, 3, 3), and the same as unit quaternions, (F, 4)
    axes: np.ndarray
    turn: np.ndarray
    # in that frame the edges are (length, 0) and (across, up), (F, 3), m
    edges: np.ndarray
    # faces with an area
    solid: np.ndarray


@njit(cache=True, nogil=True)
def face_frames(points: np.ndarray, faces: np.ndarray) -> FaceFrames:
    """Frames of a reference mesh; faces without area get unit edges along the axes and are not `solid`."""
    count = len(faces)
    axes, turn = np.empty((count, 3, 3)), np.empty((count, 4))
    edges, solid = np.empty((count, 3)), np.empty(count, np.bool_)
    plane = np.empty(4)
    for f in range(count):
        _own_plane(points, faces[f, 0], faces[f, 1], faces[f, 2], axes[f], plane)
        from_matrix(axes[f], turn[f])
        edges[f, 0], edges[f, 1], edges[f, 2] = plane[0], plane[2], plane[3]
        solid[f] = 0.5 * plane[0] * plane[3] > 1e-12
        if not solid[f]:
            edges[f, 0], edges[f, 1], edges[f, 2] = 1.0, 0.0, 1.0
    return FaceFrames(axes, turn, edges, solid)


@njit(cache=True, nogil=True)
def decompose(
    points: np.ndarray, faces: np.ndarray, axes: np.ndarray, edges: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Rotation (F, 4), a unit quaternion, and stretch (F, 3) of each face from its reference frame.

    A face and its unit normal move by F = R S. Both frames share their normal, so that S acts in the plane:
    with G the 2x2 map of the edges between the frames, R turns in the plane by atan2(G21 - G12, G11 + G22), and
    S = [[s0, s1], [s1, s2]] is what is left. Exact for every face, also one that has collapsed.

    Source: Shoemake and Duff 1992, Graphics Interface (polar factor of a 2x2 matrix in closed form).
    """
    count = len(faces)
    rotation, stretch = np.empty((count, 4)), np.empty((count, 3))
    posed, plane, r = np.empty((3, 3)), np.empty(4), np.empty((3, 3))
    for f in range(count):
        _own_plane(points, faces[f, 0], faces[f, 1], faces[f, 2], posed, plane)
        length, across, up = edges[f, 0], edges[f, 1], edges[f, 2]
        a, c = plane[0] / length, plane[1] / length
        b, d = (plane[2] - a * across) / up, (plane[3] - c * across) / up
        cosine, sine = a + d, c - b
        size = np.sqrt(cosine * cosine + sine * sine)
        if size > _TINY:
            cosine, sine = cosine / size, sine / size
        else:
            cosine, sine = 1.0, 0.0
        stretch[f, 0] = cosine * a + sine * c
        stretch[f, 1] = cosine * b + sine * d
        stretch[f, 2] = cosine * d - sine * b
        for i in range(3):
            x = posed[i, 0] * cosine + posed[i, 1] * sine
            y = posed[i, 1] * cosine - posed[i, 0] * sine
            for j in range(3):
                r[i, j] = x * axes[f, j, 0] + y * axes[f, j, 1] + posed[i, 2] * axes[f, j, 2]
        from_matrix(r, rotation[f])
    return rotation, stretch


@njit(cache=True, nogil=True)
def _own_plane(points: np.ndarray, a: int, b: int, c: int, axes: np.ndarray, plane: np.ndarray) -> None:
    """The triangle's frame (columns of `axes`) and both its edges in it: plane = (x1, y1, x2, y2)."""
    u0, u1, u2 = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
    v0, v1, v2 = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
    x0, x1, x2 = u0, u1, u2
    length = np.sqrt(u0 * u0 + u1 * u1 + u2 * u2)
    if length < _TINY:
        x0, x1, x2 = v0, v1, v2
        length = np.sqrt(v0 * v0 + v1 * v1 + v2 * v2)
        if length < _TINY:
            x0, x1, x2, length = 1.0, 0.0, 0.0, 1.0
    x0, x1, x2 = x0 / length, x1 / length, x2 / length
    n0, n1, n2 = u1 * v2 - u2 * v1, u2 * v0 - u0 * v2, u0 * v1 - u1 * v0
    size = np.sqrt(n0 * n0 + n1 * n1 + n2 * n2)
    if size < _TINY * _TINY:
        # any normal will do: the axis least along x, made perpendicular
        if abs(x0) <= abs(x1) and abs(x0) <= abs(x2):
            n0, n1, n2 = 0.0, x2, -x1
        else:
            n0, n1, n2 = -x2, 0.0, x0
            if abs(x0) + abs(x2) < 0.1:
                n0, n1, n2 = x1, -x0, 0.0
        size = np.sqrt(n0 * n0 + n1 * n1 + n2 * n2)
    n0, n1, n2 = n0 / size, n1 / size, n2 / size
    y0, y1, y2 = n1 * x2 - n2 * x1, n2 * x0 - n0 * x2, n0 * x1 - n1 * x0
    axes[0, 0], axes[1, 0], axes[2, 0] = x0, x1, x2
    axes[0, 1], axes[1, 1], axes[2, 1] = y0, y1, y2
    axes[0, 2], axes[1, 2], axes[2, 2] = n0, n1, n2
    plane[0], plane[1] = x0 * u0 + x1 * u1 + x2 * u2, y0 * u0 + y1 * u1 + y2 * u2
    plane[2], plane[3] = x0 * v0 + x1 * v1 + x2 * v2, y0 * v0 + y1 * v1 + y2 * v2
