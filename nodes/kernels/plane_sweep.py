"""How well cameras agree on small patches of a surface that is moved along its normals."""

from __future__ import annotations

import numpy as np
from numba import njit

from reperform.nodes.kernels.voxel_carving import project_row

# Variance (sum over the channels, grey levels squared) that is noise and not texture.
NOISE = 30.0
# Share of a patch that must show the performer.
_LEAST = 0.85
_QUICK = {"reassoc", "contract", "arcp"}


def sweep_cost(
    images: np.ndarray,
    rows: np.ndarray,
    points: np.ndarray,
    normals: np.ndarray,
    views: np.ndarray,
    depths: np.ndarray,
    spacing: float,
    half: int,
) -> np.ndarray:
    """Disagreement (V, L) float32 in 0..1 of the cameras about each point moved inwards by each of L depths.

    images (camera, y, x, 4) float32, 0..255: colour, matte; rows: `camera_rows`; points (V, 3) m, normals (V, 3) outward
    unit; views (V, K) int32: the cameras that look at each point, -1 for none; depths (L,) m. At x = p - depth n lies
    a square of (2 half + 1)^2 samples `spacing` m apart, in the plane across n. With z the normalised correlation of
    two cameras' samples, means taken per channel and `NOISE` added to each variance, and z = 0 where it is negative,
    cost = 1 - (mean + largest of z over the pairs of cameras) / 2. A camera in which the square leaves the picture, or
    is covered by its matte to less than 85 %, is not asked; the cost is 1 where fewer than two remain, and near 1
    where there is no texture.

    Source: Collins 1996, CVPR (plane sweep); Goesele, Curless and Seitz 2006, CVPR (correlation of several views).
    Departure: planes across the surface's own normals; half of the vote goes to the best pair, since one of the
    cameras may be hidden from the true surface.
    """
    return np.asarray(
        _sweep(
            np.ascontiguousarray(images, np.float32),
            rows,
            np.ascontiguousarray(points, np.float64),
            np.ascontiguousarray(normals, np.float64),
            np.ascontiguousarray(views, np.int32),
            np.asarray(depths, np.float64),
            float(spacing),
            int(half),
        )
    )


@njit(cache=True, nogil=True, fastmath=_QUICK)
def _sweep(
    images: np.ndarray,
    rows: np.ndarray,
    points: np.ndarray,
    normals: np.ndarray,
    views: np.ndarray,
    depths: np.ndarray,
    spacing: float,
    half: int,
) -> np.ndarray:
    most = views.shape[1]
    size = 3 * (2 * half + 1) ** 2
    cost = np.ones((len(points), len(depths)), np.float32)
    patch = np.empty((most, size), np.float32)
    power = np.empty(most, np.float32)
    frame = np.empty((3, 3))
    for v in range(len(points)):
        _tangents(normals[v], spacing, frame)
        for d in range(len(depths)):
            for i in range(3):
                frame[0, i] = points[v, i] - depths[d] * normals[v, i]
            for k in range(most):
                power[k] = -1.0
                if views[v, k] >= 0:
                    power[k] = _sample(images[views[v, k]], rows[views[v, k]], frame, half, patch[k])
            total, pairs, best = 0.0, 0, 0.0
            for k in range(most):
                for m in range(k):
                    if power[k] < 0 or power[m] < 0:
                        continue
                    together = np.float32(0)
                    for i in range(size):
                        together += patch[k, i] * patch[m, i]
                    score = max(0.0, together / np.sqrt(power[k] * power[m]))
                    best = max(best, score)
                    total += score
                    pairs += 1
            if pairs:
                cost[v, d] = 1 - 0.5 * (total / pairs + best)
    return cost


@njit(cache=True, nogil=True, inline="always")
def _tangents(normal: np.ndarray, spacing: float, frame: np.ndarray) -> None:
    """Rows 1 and 2 of `frame`: two vectors of length `spacing` across the normal, at right angles."""
    if abs(normal[1]) < 0.9:
        x, y, z = normal[2], 0.0, -normal[0]
    else:
        x, y, z = 0.0, -normal[2], normal[1]
    scale = spacing / np.sqrt(x * x + y * y + z * z)
    frame[1, 0], frame[1, 1], frame[1, 2] = scale * x, scale * y, scale * z
    frame[2, 0] = normal[1] * frame[1, 2] - normal[2] * frame[1, 1]
    frame[2, 1] = normal[2] * frame[1, 0] - normal[0] * frame[1, 2]
    frame[2, 2] = normal[0] * frame[1, 1] - normal[1] * frame[1, 0]


@njit(cache=True, nogil=True, fastmath=_QUICK)
def _sample(image: np.ndarray, row: np.ndarray, frame: np.ndarray, half: int, patch: np.ndarray) -> float:
    """Fill `patch` with the samples less their means per channel; their power with noise, -1 if out of the picture."""
    px, py, pz = frame[0]
    x0, y0, depth = project_row(row, px, py, pz)
    ax, ay, near_a = project_row(row, px + frame[1, 0], py + frame[1, 1], pz + frame[1, 2])
    bx, by, near_b = project_row(row, px + frame[2, 0], py + frame[2, 1], pz + frame[2, 2])
    if depth <= 0 or near_a <= 0 or near_b <= 0:
        return -1.0
    ax, ay, bx, by = ax - x0, ay - y0, bx - x0, by - y0
    reach_x, reach_y = half * (abs(ax) + abs(bx)), half * (abs(ay) + abs(by))
    inside = x0 - reach_x >= 0 and y0 - reach_y >= 0
    if not (inside and x0 + reach_x < image.shape[1] - 1 and y0 + reach_y < image.shape[0] - 1):
        return -1.0
    sum0, sum1, sum2, cover = np.float32(0), np.float32(0), np.float32(0), np.float32(0)
    one = np.float32(1)
    i = 0
    for a in range(-half, half + 1):
        for b in range(-half, half + 1):
            x, y = x0 + a * ax + b * bx, y0 + a * ay + b * by
            c, r = int(x), int(y)
            fx, fy = np.float32(x - c), np.float32(y - r)
            w00, w01, w10, w11 = (one - fx) * (one - fy), fx * (one - fy), (one - fx) * fy, fx * fy
            top, bottom = image[r], image[r + 1]
            red = top[c, 0] * w00 + top[c + 1, 0] * w01 + bottom[c, 0] * w10 + bottom[c + 1, 0] * w11
            green = top[c, 1] * w00 + top[c + 1, 1] * w01 + bottom[c, 1] * w10 + bottom[c + 1, 1] * w11
            blue = top[c, 2] * w00 + top[c + 1, 2] * w01 + bottom[c, 2] * w10 + bottom[c + 1, 2] * w11
            cover += top[c, 3] * w00 + top[c + 1, 3] * w01 + bottom[c, 3] * w10 + bottom[c + 1, 3] * w11
            patch[i], patch[i + 1], patch[i + 2] = red, green, blue
            sum0 += red
            sum1 += green
            sum2 += blue
            i += 3
    count = np.float32(i // 3)
    if cover < 255 * _LEAST * count:
        return -1.0
    sum0, sum1, sum2 = sum0 / count, sum1 / count, sum2 / count
    power = np.float32(0)
    for i in range(0, len(patch), 3):
        patch[i] -= sum0
        patch[i + 1] -= sum1
        patch[i + 2] -= sum2
    for i in range(len(patch)):
        power += patch[i] * patch[i]
    return float(power + NOISE * count)
