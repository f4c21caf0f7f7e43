"""Rotations in batches: exponential, logarithm, polar decomposition and interpolation.

Matrices are (..., 3, 3) and act on column vectors; a rotation vector (..., 3) is axis times angle in radians.
"""

from __future__ import annotations

import numpy as np


def exp(vectors: np.ndarray) -> np.ndarray:
    """Rotation matrices from rotation vectors of any length (Rodrigues)."""
    v = np.asarray(vectors, np.float64)
    square = np.einsum("...k,...k->...", v, v)
    angle = np.sqrt(square)
    # sinc keeps full accuracy at small angles: sin(t)/t and (1 - cos t)/t^2 = sinc(t/2)^2 / 2
    a = np.sinc(angle / np.pi)
    b = 0.5 * np.sinc(angle / (2 * np.pi)) ** 2
    x, y, z = v[..., 0], v[..., 1], v[..., 2]
    c = 1.0 - b * square
    return np.stack(
        [
            np.stack([c + b * x * x, b * x * y - a * z, b * x * z + a * y], -1),
            np.stack([b * x * y + a * z, c + b * y * y, b * y * z - a * x], -1),
            np.stack([b * x * z - a * y, b * y * z + a * x, c + b * z * z], -1),
        ],
        -2,
    )


def log(matrices: np.ndarray) -> np.ndarray:
    """Rotation vectors of rotation matrices, angle in [0, pi]; accurate near 0 and near pi (quaternions)."""
    q = quaternion(matrices)
    imaginary = np.linalg.norm(q[..., 1:], axis=-1)
    angle = 2.0 * np.arctan2(imaginary, q[..., 0])
    # angle / sin(angle / 2) tends to 2
    scale = np.divide(angle, imaginary, out=np.full_like(angle, 2.0), where=imaginary > 1e-12)
    return q[..., 1:] * scale[..., None]


def quaternion(matrices: np.ndarray) -> np.ndarray:
    """Unit quaternions (..., 4), w x y z with w >= 0, of rotation matrices (Shepperd's four cases)."""
    m = np.asarray(matrices, np.float64)
    d = np.diagonal(m, axis1=-2, axis2=-1)
    trace = d.sum(-1)
    four = np.stack([trace, *(2.0 * d[..., k] - trace for k in range(3))], -1)
    yz, zx, xy = (m[..., j, i] - m[..., i, j] for i, j in ((1, 2), (2, 0), (0, 1)))
    pyz, pzx, pxy = (m[..., j, i] + m[..., i, j] for i, j in ((1, 2), (2, 0), (0, 1)))
    one = 1.0 + four
    cases = np.stack(
        [
            np.stack([one[..., 0], yz, zx, xy], -1),
            np.stack([yz, one[..., 1], pxy, pzx], -1),
            np.stack([zx, pxy, one[..., 2], pyz], -1),
            np.stack([xy, pzx, pyz, one[..., 3]], -1),
        ],
        -2,
    )
    best = np.argmax(four, axis=-1)
    q = np.take_along_axis(cases, best[..., None, None], axis=-2)[..., 0, :]
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    return np.where(q[..., :1] < 0.0, -q, q)


def polar(matrices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Polar decomposition M = R S with R a proper rotation and S symmetric.

    R maximises trace(R^T M) over proper rotations; S is positive definite where det M > 0.
    Source: Higham 1986, SIAM J. Sci. Stat. Comput.; by singular values, with the reflection moved into S.
    """
    m = np.asarray(matrices, np.float64)
    u, s, vt = np.linalg.svd(m)
    flip = np.where(np.linalg.det(u @ vt) < 0.0, -1.0, 1.0)
    u = u.copy()
    u[..., 2] *= flip[..., None]
    s = s.copy()
    s[..., 2] *= flip
    return u @ vt, np.swapaxes(vt, -1, -2) @ (s[..., None] * vt)


def slerp(a: np.ndarray, b: np.ndarray, weight: float | np.ndarray) -> np.ndarray:
    """The rotation at `weight` of the shortest way from a (0) to b (1): a exp(weight log(a^T b))."""
    relative = log(np.swapaxes(a, -1, -2) @ b)
    return a @ exp(np.asarray(weight)[..., None] * relative)
