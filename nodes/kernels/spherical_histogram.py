"""How the volume of a solid lies around a point, by distance, polar angle and azimuth."""

from __future__ import annotations

import math

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def volume_centroid(vertices: np.ndarray, faces: np.ndarray) -> tuple[float, np.ndarray]:
    """Volume (m^3) and centroid (3,) of the solid that a closed mesh bounds, from signed tetrahedra."""
    total = 0.0
    moment = np.zeros(3)
    origin = vertices[0].astype(np.float64)
    for f in range(len(faces)):
        a = vertices[faces[f, 0]] - origin
        b = vertices[faces[f, 1]] - origin
        c = vertices[faces[f, 2]] - origin
        volume = _triple(a, b, c) / 6
        total += volume
        for k in range(3):
            moment[k] += volume * (a[k] + b[k] + c[k]) / 4
    return total, origin + moment / (total if total != 0 else 1.0)


@njit(cache=True, nogil=True)
def spherical_histogram(
    vertices: np.ndarray,
    faces: np.ndarray,
    centre: np.ndarray,
    reach: float,
    radial: int,
    polar: int,
    azimuth: int,
) -> np.ndarray:
    """Volume (m^3) of the solid in each bin (radial, polar, azimuth) around `centre`; what lies past
    `reach` counts in the outermost shell.

    Every face and the centre span a signed tetrahedron; it is cut into slim cones that are narrower than a
    bin and each cone's volume is split exactly over the shells it crosses, linearly over the two nearest
    polar and azimuth bins. So the histogram sums to the volume, and changes smoothly with rotation.
    """
    histogram = np.zeros((radial, polar, azimuth))
    limit = 0.5 * min(math.pi / polar, 2 * math.pi / azimuth)
    for f in range(len(faces)):
        a = vertices[faces[f, 0]] - centre
        b = vertices[faces[f, 1]] - centre
        c = vertices[faces[f, 2]] - centre
        edge = max(_distance(a, b), _distance(b, c), _distance(c, a))
        near = max(min(_norm(a), _norm(b), _norm(c)), 1e-9)
        cuts = min(max(math.ceil(edge / near / limit), 1), 16)
        volume = _triple(a, b, c) / 6 / (cuts * cuts)
        for i in range(cuts):
            for j in range(2 * (cuts - i) - 1):
                # barycentrics of the centre of small triangle j of strip i; odd ones point the other way
                p = (i + (2 / 3 if j % 2 else 1 / 3)) / cuts
                q = (j // 2 + (2 / 3 if j % 2 else 1 / 3)) / cuts
                x = p * a[0] + q * b[0] + (1 - p - q) * c[0]
                y = p * a[1] + q * b[1] + (1 - p - q) * c[1]
                z = p * a[2] + q * b[2] + (1 - p - q) * c[2]
                _add_cone(histogram, x, y, z, volume, reach)
    return histogram


@njit(cache=True, nogil=True, inline="always")
def _add_cone(histogram: np.ndarray, x: float, y: float, z: float, volume: float, reach: float) -> None:
    radial, polar, azimuth = histogram.shape
    r = max(math.sqrt(x * x + y * y + z * z), 1e-12)
    u = math.acos(min(max(y / r, -1.0), 1.0)) / math.pi * polar - 0.5
    v = math.atan2(x, z) / (2 * math.pi) * azimuth - 0.5
    p, k = math.floor(u), math.floor(v)
    fu, fv = u - p, v - k
    p0, p1 = min(max(p, 0), polar - 1), min(p + 1, polar - 1)
    k0, k1 = k % azimuth, (k + 1) % azimuth
    width = reach / radial
    for s in range(radial):
        inner = s * width
        if inner >= r:
            break
        outer = r if s == radial - 1 else min((s + 1) * width, r)
        part = volume * (outer**3 - inner**3) / r**3
        histogram[s, p0, k0] += part * (1 - fu) * (1 - fv)
        histogram[s, p0, k1] += part * (1 - fu) * fv
        histogram[s, p1, k0] += part * fu * (1 - fv)
        histogram[s, p1, k1] += part * fu * fv


@njit(cache=True, nogil=True, inline="always")
def _triple(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> float:
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


@njit(cache=True, nogil=True, inline="always")
def _norm(a: np.ndarray) -> float:
    return math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


@njit(cache=True, nogil=True, inline="always")
def _distance(a: np.ndarray, b: np.ndarray) -> float:
    return math.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)
