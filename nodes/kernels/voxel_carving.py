"""Fractional visual hulls: how far every voxel's footprint is covered in every matte, combined over cameras."""

from __future__ import annotations

import cv2
import numpy as np
from numba import njit

from reperform.nodes.kernels.camera import radial_limit

# Certainty of a single matte: neither 0 nor 1, so that odds stay finite.
_DOUBT = 1e-3
# Odds against from which on one matte settles it: the rest would only make p < 0.01 smaller.
_SURE = 99.0


def integral_images(alpha: np.ndarray) -> np.ndarray:
    """Sums of (camera, y, x) uint8 over all pixels above and left, (camera, y + 1, x + 1) int32.

    Raises ValueError for pictures so large that the sums overflow.
    """
    cameras, height, width = alpha.shape
    if height * width * 255 >= 2**31:
        raise ValueError(f"mattes of {width}x{height} px are too large: at most 8.4 million pixels")
    sums = np.empty((cameras, height + 1, width + 1), np.int32)
    for camera in range(cameras):
        cv2.integral(alpha[camera], sums[camera], sdepth=cv2.CV_32S)
    return sums


def camera_rows(
    matrix: np.ndarray, rotation: np.ndarray, translation: np.ndarray, distortion: np.ndarray
) -> np.ndarray:
    """Everything the kernels need of each camera in one float64 row (camera, 23)."""
    limits = np.array([radial_limit(lens) ** 2 for lens in distortion])
    return np.concatenate(
        [
            rotation.reshape(-1, 9),
            translation.reshape(-1, 3),
            matrix[:, 0, 0:1],
            matrix[:, 1, 1:2],
            matrix[:, 0, 1:2],
            matrix[:, 0, 2:3],
            matrix[:, 1, 2:3],
            distortion.reshape(-1, 5),
            limits[:, None],
        ],
        axis=1,
    ).astype(np.float64)


@njit(cache=True, nogil=True, inline="always")
def project_row(row: np.ndarray, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Pixel of a point and its depth; depth <= 0 where the camera cannot see it. row: `camera_rows`."""
    cz = row[6] * x + row[7] * y + row[8] * z + row[11]
    if cz <= 1e-6:
        return 0.0, 0.0, -1.0
    u = (row[0] * x + row[1] * y + row[2] * z + row[9]) / cz
    v = (row[3] * x + row[4] * y + row[5] * z + row[10]) / cz
    r2 = u * u + v * v
    if r2 >= row[22]:
        return 0.0, 0.0, -1.0
    radial = 1 + r2 * (row[17] + r2 * (row[18] + r2 * row[21]))
    lens_u = u * radial + 2 * row[19] * u * v + row[20] * (r2 + 2 * u * u)
    lens_v = v * radial + row[19] * (r2 + 2 * v * v) + 2 * row[20] * u * v
    return row[12] * lens_u + row[14] * lens_v + row[15], row[13] * lens_v + row[16], cz


@njit(cache=True, nogil=True, inline="always")
def _integral_at(sums: np.ndarray, x: float, y: float) -> float:
    """Integral of the piecewise constant picture up to the corner (x, y), in pixels from its border."""
    i, j = int(x), int(y)
    i = min(i, sums.shape[1] - 2)
    j = min(j, sums.shape[0] - 2)
    fx, fy = x - i, y - j
    top = sums[j, i] + fx * (sums[j, i + 1] - sums[j, i])
    bottom = sums[j + 1, i] + fx * (sums[j + 1, i + 1] - sums[j + 1, i])
    return top + fy * (bottom - top)


@njit(cache=True, nogil=True, inline="always")
def _covered(sums: np.ndarray, x: float, y: float, half: float) -> float:
    """Mean coverage 0 .. 1 of the square of half width `half` px about pixel (x, y); -1 outside the picture."""
    height, width = sums.shape[0] - 1, sums.shape[1] - 1
    x += 0.5
    y += 0.5
    if x < 0 or y < 0 or x > width or y > height:
        return -1.0
    left, right = max(x - half, 0.0), min(x + half, float(width))
    top, bottom = max(y - half, 0.0), min(y + half, float(height))
    total = (
        _integral_at(sums, right, bottom)
        - _integral_at(sums, left, bottom)
        - _integral_at(sums, right, top)
        + _integral_at(sums, left, top)
    )
    return total / (255.0 * (right - left) * (bottom - top))


@njit(cache=True, nogil=True, inline="always")
def _covered_pixels(sums: np.ndarray, left: float, top: float, right: float, bottom: float) -> float:
    """Covered area, px, of a rectangle inside the picture, whose first pixel reaches from -0.5 to 0.5."""
    total = (
        _integral_at(sums, right + 0.5, bottom + 0.5)
        - _integral_at(sums, left + 0.5, bottom + 0.5)
        - _integral_at(sums, right + 0.5, top + 0.5)
        + _integral_at(sums, left + 0.5, top + 0.5)
    )
    return total / 255.0


@njit(cache=True, nogil=True, inline="always")
def _occupied(
    sums: np.ndarray,
    rows: np.ndarray,
    x: float,
    y: float,
    z: float,
    half: float,
    misses: int,
    views: int,
    against: np.ndarray,
) -> float:
    """Probability of occupancy of one place; `against` is room for one number per camera."""
    seen = 0
    sure = 0
    total = 0.0
    for camera in range(len(rows)):
        px, py, depth = project_row(rows[camera], x, y, z)
        if depth <= 0:
            continue
        focal = 0.5 * (rows[camera, 12] + rows[camera, 13])
        p = _covered(sums[camera], px, py, max(half * focal / depth, 0.5))
        if p < 0:
            continue
        p = min(max(p, _DOUBT), 1 - _DOUBT)
        against[seen] = (1 - p) / p
        total += against[seen]
        sure += against[seen] > _SURE
        seen += 1
        if sure > misses:
            return 0.0
    if seen < views:
        return 0.0
    for _ in range(min(misses, seen - 1)):
        worst = 0
        for k in range(1, seen):
            if against[k] > against[worst]:
                worst = k
        total -= against[worst]
        against[worst] = 0.0
    return 1 / (1 + max(total, 0.0))


@njit(cache=True, nogil=True)
def carve(
    sums: np.ndarray,
    rows: np.ndarray,
    origin: np.ndarray,
    voxel: float,
    blocks: np.ndarray,
    block: int,
    misses: int,
    views: int,
    out: np.ndarray,
) -> None:
    """Probability of occupancy of the voxels of the marked blocks, into `out` (x, y, z) float32.

    sums: integral images of the mattes; rows: `camera_rows`; voxel (i, j, k) is centred at origin + voxel (i, j, k);
    blocks (x, y, z) bool: blocks of `block` voxels to evaluate. A camera that does not see a voxel says nothing of
    it; voxels seen by fewer than `views` cameras are empty. Probabilities under 0.01 may be given as 0.
    """
    against = np.empty(len(rows))
    half = 0.5 * voxel
    nx, ny, nz = out.shape
    for bi in range(blocks.shape[0]):
        for bj in range(blocks.shape[1]):
            for bk in range(blocks.shape[2]):
                if not blocks[bi, bj, bk]:
                    continue
                for i in range(bi * block, min(bi * block + block, nx)):
                    x = origin[0] + voxel * i
                    for j in range(bj * block, min(bj * block + block, ny)):
                        y = origin[1] + voxel * j
                        for k in range(bk * block, min(bk * block + block, nz)):
                            out[i, j, k] = _occupied(
                                sums, rows, x, y, origin[2] + voxel * k, half, misses, views, against
                            )


@njit(cache=True, nogil=True)
def may_be_occupied(
    sums: np.ndarray,
    rows: np.ndarray,
    origin: np.ndarray,
    size: float,
    shape: tuple[int, int, int],
    misses: int,
    views: int,
) -> np.ndarray:
    """Which cells of a coarse grid may hold something: bool (x, y, z), True where in doubt.

    Cell (i, j, k) is the cube of edge `size` centred at origin + size (i, j, k). It is empty when more than
    `misses` cameras that see all of it show nothing in the square around its bounding sphere. A camera at whose
    border it lies and that shows nothing in its part of the square is one camera less to see an occupied place.
    """
    out = np.zeros(shape, np.bool_)
    radius = 0.8661 * size
    for i in range(shape[0]):
        for j in range(shape[1]):
            for k in range(shape[2]):
                x, y, z = origin[0] + size * i, origin[1] + size * j, origin[2] + size * k
                seen, empty, partly = 0, 0, 0
                for camera in range(len(rows)):
                    px, py, depth = project_row(rows[camera], x, y, z)
                    if depth <= 2 * radius:
                        # too near or behind: says nothing, and may see part of the cell
                        seen += 1
                        continue
                    focal = max(rows[camera, 12], rows[camera, 13])
                    # 1.25: how much more than f / z a lens may stretch, and the nearer side of the sphere
                    half = 1.25 * radius * focal / (depth - radius) + 1.0
                    left, top = max(px - half, -0.5), max(py - half, -0.5)
                    right = min(px + half, sums.shape[2] - 1.5)
                    bottom = min(py + half, sums.shape[1] - 1.5)
                    if left >= right or top >= bottom:
                        continue
                    seen += 1
                    if _covered_pixels(sums[camera], left, top, right, bottom) < 0.25:
                        if right - left > 1.999 * half and bottom - top > 1.999 * half:
                            empty += 1
                            if empty > misses:
                                break
                        else:
                            # a place in the cell is empty to this camera, or not seen by it
                            partly += 1
                out[i, j, k] = empty <= misses and seen - max(partly + empty - misses, 0) >= views
    return out
