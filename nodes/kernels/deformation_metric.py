"""How far two poses of one topology are apart by the rotation and stretch of their faces.

A pose is prepared once, against any reference pose: each face carries the quaternion q of an orthonormal frame
(two directions in its plane, its normal) and the symmetric 2 x 2 stretch U of its plane, chosen so that
[e1 e2] = Q U E with the reference's plane edges E. Between poses i and j the gradient of a face is then

    T = Q_j (U_j U_i^-1 + s) Q_i^T,   s = sqrt(det U_j / det U_i) along the normal

whose polar decomposition has a closed form: in the plane a turn by theta = atan2(M21 - M12, M11 + M22) with
M = U_j U_i^-1. No decomposition is left to do per pair.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from reperform.nodes.kernels.quaternion import from_matrix

# asin(z) = z p(z^2) on the range that half chords of unit quaternions up to sign have, z^2 <= 1/2
_ASIN = tuple(
    np.polynomial.chebyshev.Chebyshev.interpolate(
        lambda u: np.arcsin(np.sqrt(np.maximum(u, 1e-300))) / np.sqrt(np.maximum(u, 1e-300)), 8, [0.0, 0.5]
    )
    .convert(kind=np.polynomial.Polynomial)
    .coef.astype(np.float32)
)
_A0, _A1, _A2, _A3, _A4, _A5, _A6, _A7, _A8 = (np.float32(a) for a in _ASIN)
# sums run in float32 within blocks of so many faces and in float64 over blocks
_BLOCK = 1024
# eigenvalues of a face's metric are kept above this share of the larger: slivers have no gradient
_SLIVER = 1e-8


class Poses(NamedTuple):
    """Poses made ready: per frame and face q (w, x, y, z) and U (11, 12, 22), and ground points for alignment."""

    faces: np.ndarray  # (T, 7, F) float32
    ground: np.ndarray  # (T, V) complex64: x + i z, centred and times the root of the weight


class Reference(NamedTuple):
    """What poses are prepared against: plane edges and frames of its faces, areas and alignment weights."""

    triangles: np.ndarray  # (F, 3) int32
    inverse_edges: np.ndarray  # (F, 2, 2): E^-1
    frame: np.ndarray  # (F, 4) quaternions
    area: np.ndarray  # (F,) float32 shares that sum to 1
    weight: np.ndarray  # (V,) that sum to 1


def reference_pose(vertices: np.ndarray, faces: np.ndarray, weight: np.ndarray) -> Reference:
    """Take the reference apart.

    vertices (V, 3), m; faces (F, 3); weight (V,) of the vertices in the alignment, not negative.
    Raises ValueError where a face names no vertex, no face has an area, or no weight is positive.
    """
    points, triangles = np.asarray(vertices, np.float64), np.ascontiguousarray(faces, np.int32)
    if not len(triangles) or triangles.min() < 0 or triangles.max() >= len(points):
        raise ValueError(f"faces must name vertices 0 .. {len(points) - 1}, got {len(triangles)} faces")
    u, v = (points[triangles[:, k]] - points[triangles[:, 0]] for k in (1, 2))
    first = u / np.maximum(np.linalg.norm(u, axis=1, keepdims=True), 1e-12)
    across = v - np.einsum("fk,fk->f", first, v)[:, None] * first
    height = np.linalg.norm(across, axis=1)
    area = 0.5 * np.linalg.norm(u, axis=1) * height
    if not area.sum() > 0:
        raise ValueError("no face of the reference pose has an area: take another frame as the first")
    if weight.shape != (len(points),) or not weight.sum() > 0 or weight.min() < 0:
        raise ValueError(f"alignment needs {len(points)} weights, not negative, with a positive sum")
    edges = np.zeros((len(triangles), 2, 2))
    edges[:, 0, 0] = np.linalg.norm(u, axis=1)
    edges[:, 0, 1] = np.einsum("fk,fk->f", first, v)
    edges[:, 1, 1] = height
    solid = area > 1e-6 * area.mean()
    edges[~solid] = np.sqrt(area.mean()) * np.eye(2)
    area = np.where(solid, area, 0.0)
    inverse = np.ascontiguousarray(np.linalg.inv(edges))
    frame = _prepare(np.ascontiguousarray(points[None]), triangles, inverse)[0, :4].T
    return Reference(
        triangles, inverse, frame.astype(np.float64), (area / area.sum()).astype(np.float32), weight / weight.sum()
    )  # fmt: skip


def prepare(vertices: np.ndarray, reference: Reference) -> Poses:
    """Make frames (T, V, 3) of the reference's topology ready to be compared."""
    points = np.ascontiguousarray(vertices, np.float64)
    ground = points[:, :, 0] + 1j * points[:, :, 2]
    ground = (ground - (ground @ reference.weight)[:, None]) * np.sqrt(reference.weight)
    faces = _prepare(points, reference.triangles, reference.inverse_edges)
    return Poses(faces, ground.astype(np.complex64))


def turns(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The turn about the vertical that lays frame j of b on frame i of a, weighted least squares: (Ta, Tb).

    a, b: the ground points of both, (T, V).
    """
    # with g = x + i z the placement's yaw multiplies g by exp(-i yaw)
    return np.asarray(np.angle(a.conj() @ b.T), np.float64)


def exact_distances(a: Poses, b: Poses, area: np.ndarray, stretch_weight: float) -> np.ndarray:
    """d(i, j) for all frames of a and b, radians, (Ta, Tb) float64.

    d = sum_m A_m (angle(R_m) + stretch_weight (|S_m - I| + |S_m^-1 - I|) / 2) with areas A that sum to 1.
    """
    return _exact(a.faces, b.faces, turns(a.ground, b.ground), area, np.float32(0.5 * stretch_weight))


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def _exact(p: np.ndarray, q: np.ndarray, yaw: np.ndarray, area: np.ndarray, weight: np.float32) -> np.ndarray:
    out = np.empty((len(p), len(q)))
    for i in range(len(p)):
        for j in range(len(q)):
            cy, sy = np.float32(np.cos(0.5 * yaw[i, j])), np.float32(np.sin(0.5 * yaw[i, j]))
            total = 0.0
            for start in range(0, len(area), _BLOCK):
                stop = min(start + _BLOCK, len(area))
                total += _block(p[i], q[j], start, stop, cy, sy, area, weight)
            out[i, j] = total
    return out


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def _block(
    p: np.ndarray, q: np.ndarray, start: int, stop: int, cy: np.float32, sy: np.float32, area: np.ndarray,
    weight: np.float32,
) -> np.float32:  # fmt: skip
    """The sum over faces start .. stop - 1 of one pair of frames."""
    total = np.float32(0.0)
    one, half = np.float32(1.0), np.float32(0.5)
    for m in range(start, stop):
        # M = U_j adj(U_i) / det U_i
        det = p[4, m] * p[6, m] - p[5, m] * p[5, m]
        other = q[4, m] * q[6, m] - q[5, m] * q[5, m]
        over = one / det
        m11 = (q[4, m] * p[6, m] - q[5, m] * p[5, m]) * over
        m12 = (q[5, m] * p[4, m] - q[4, m] * p[5, m]) * over
        m21 = (q[5, m] * p[6, m] - q[6, m] * p[5, m]) * over
        m22 = (q[6, m] * p[4, m] - q[5, m] * p[5, m]) * over
        trace = np.sqrt((m11 + m22) * (m11 + m22) + (m21 - m12) * (m21 - m12))
        cosine, sine = (m11 + m22) / trace, (m21 - m12) / trace
        c = np.sqrt(half + half * cosine)
        s = half * sine / c
        # |M - turn|^2 = |S - I|^2 in the plane, the normal beside it, and the same of the inverse
        ratio = other * over
        normal = np.sqrt(ratio)
        d11, d22, d12, d21 = m11 - cosine, m22 - cosine, m12 + sine, m21 - sine
        there = d11 * d11 + d22 * d22 + d12 * d12 + d21 * d21 + (normal - one) * (normal - one)
        inverse, shrunk = one / ratio, one / normal - one
        d11, d22 = m22 * inverse - cosine, m11 * inverse - cosine
        d12, d21 = m12 * inverse + sine, m21 * inverse - sine
        back = d11 * d11 + d22 * d22 + d12 * d12 + d21 * d21 + shrunk * shrunk
        shear = np.sqrt(there) + np.sqrt(back)
        # yaw q_j (turn by theta about the normal)
        w = q[0, m] * c - q[3, m] * s
        x = q[1, m] * c + q[2, m] * s
        y = q[2, m] * c - q[1, m] * s
        z = q[3, m] * c + q[0, m] * s
        rw, rx = cy * w - sy * y, cy * x + sy * z
        ry, rz = cy * y + sy * w, cy * z - sy * x
        dot = rw * p[0, m] + rx * p[1, m] + ry * p[2, m] + rz * p[3, m]
        sign = one if dot >= np.float32(0.0) else -one
        dw, dx, dy, dz = rw - sign * p[0, m], rx - sign * p[1, m], ry - sign * p[2, m], rz - sign * p[3, m]
        chord = dw * dw + dx * dx + dy * dy + dz * dz
        total += area[m] * (angle_of_chord(chord) + weight * shear)
    return total


@njit(cache=True, nogil=True, fastmath=True, inline="always")
def angle_of_chord(chord: np.float32) -> np.float32:
    """The angle of a rotation, 4 asin(|p - q| / 2), from the square of the chord of its quaternions."""
    u = np.float32(0.25) * chord
    tail = _A4 + u * (_A5 + u * (_A6 + u * (_A7 + u * _A8)))
    return np.float32(4.0) * np.sqrt(u) * (_A0 + u * (_A1 + u * (_A2 + u * (_A3 + u * tail))))


@njit(cache=True, nogil=True)
def _prepare(points: np.ndarray, triangles: np.ndarray, inverse: np.ndarray) -> np.ndarray:
    """q and U of every face of every frame: B = [e1 e2] E^-1, U = sqrt(B^T B), directions B U^-1."""
    out = np.empty((len(points), 7, len(triangles)), np.float32)
    b, r, q = np.empty((3, 2)), np.empty((3, 3)), np.empty(4)
    for t in range(len(points)):
        for f in range(len(triangles)):
            v0, v1, v2 = triangles[f, 0], triangles[f, 1], triangles[f, 2]
            for k in range(3):
                e1, e2 = points[t, v1, k] - points[t, v0, k], points[t, v2, k] - points[t, v0, k]
                b[k, 0] = e1 * inverse[f, 0, 0] + e2 * inverse[f, 1, 0]
                b[k, 1] = e1 * inverse[f, 0, 1] + e2 * inverse[f, 1, 1]
            c11 = b[0, 0] ** 2 + b[1, 0] ** 2 + b[2, 0] ** 2
            c22 = b[0, 1] ** 2 + b[1, 1] ** 2 + b[2, 1] ** 2
            c12 = b[0, 0] * b[0, 1] + b[1, 0] * b[1, 1] + b[2, 0] * b[2, 1]
            floor = _SLIVER * (c11 + c22) + 1e-12
            c11, c22 = c11 + floor, c22 + floor
            root = np.sqrt(max(c11 * c22 - c12 * c12, 0.0))
            scale = 1.0 / np.sqrt(c11 + c22 + 2.0 * root)
            u11, u12, u22 = (c11 + root) * scale, c12 * scale, (c22 + root) * scale
            det = u11 * u22 - u12 * u12
            for k in range(3):
                r[k, 0] = (b[k, 0] * u22 - b[k, 1] * u12) / det
                r[k, 1] = (b[k, 1] * u11 - b[k, 0] * u12) / det
            _orthonormal(r)
            from_matrix(r, q)
            for k in range(4):
                out[t, k, f] = q[k]
            out[t, 4, f], out[t, 5, f], out[t, 6, f] = u11, u12, u22
    return out


@njit(cache=True, nogil=True)
def _orthonormal(r: np.ndarray) -> None:
    """Make the first two columns orthonormal and the third their cross product."""
    norm = np.sqrt(r[0, 0] ** 2 + r[1, 0] ** 2 + r[2, 0] ** 2)
    dot = 0.0
    for k in range(3):
        r[k, 0] /= norm
        dot += r[k, 0] * r[k, 1]
    for k in range(3):
        r[k, 1] -= dot * r[k, 0]
    norm = np.sqrt(r[0, 1] ** 2 + r[1, 1] ** 2 + r[2, 1] ** 2)
    for k in range(3):
        r[k, 1] /= norm
        r[k, 2] = r[(k + 1) % 3, 0] * r[(k + 2) % 3, 1] - r[(k + 2) % 3, 0] * r[(k + 1) % 3, 1]
