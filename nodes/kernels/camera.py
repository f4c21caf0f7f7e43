"""OpenCV's camera model: projection, centre, and the pose that looks at a point."""

from __future__ import annotations

import numpy as np


def project(
    points: np.ndarray,
    matrix: np.ndarray,
    rotation: np.ndarray,
    translation: np.ndarray,
    distortion: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Pixels (N, 2) and depths (N,) of world points (N, 3); pixel (0, 0) is the centre of the first pixel.

    x_cam = R x + t;  (u, v) = x_cam[:2] / z;  r^2 = u^2 + v^2;  d = 1 + k1 r^2 + k2 r^4 + k3 r^6;
    u' = u d + 2 p1 u v + p2 (r^2 + 2 u^2);  v' = v d + p1 (r^2 + 2 v^2) + 2 p2 u v;  pixel = K (u', v', 1).
    distortion: (5,) k1 k2 p1 p2 k3. Points at or behind the camera plane, and points so far out that the
    radial model folds back (`radial_limit`), get nan pixels; the depth z (points' unit) is always given.

    Source: Brown 1966, Photogrammetric Engineering 32(3); OpenCV calib3d.
    """
    camera = np.asarray(points, np.float64).reshape(-1, 3) @ np.asarray(rotation, np.float64).T + translation
    depth = camera[:, 2].copy()
    front = depth > 0
    normalised = np.full((len(camera), 2), np.nan)
    np.divide(camera[:, :2], depth[:, None], out=normalised, where=front[:, None])
    if distortion is not None and np.any(distortion):
        normalised = distort(normalised, np.asarray(distortion, np.float64))
    return normalised @ np.asarray(matrix, np.float64)[:2, :2].T + np.asarray(matrix)[:2, 2], depth


def distort(normalised: np.ndarray, distortion: np.ndarray) -> np.ndarray:
    """Where the lens shows ideal image points (N, 2) of unit focal length; nan beyond `radial_limit`."""
    k1, k2, p1, p2, k3 = distortion
    u, v = normalised[:, 0], normalised[:, 1]
    squared = u * u + v * v
    radial = 1 + squared * (k1 + squared * (k2 + squared * k3))
    lens = np.stack(
        [
            u * radial + 2 * p1 * u * v + p2 * (squared + 2 * u * u),
            v * radial + p1 * (squared + 2 * v * v) + 2 * p2 * u * v,
        ],
        axis=1,
    )
    lens[~(squared < radial_limit(distortion) ** 2)] = np.nan
    return lens


def radial_limit(distortion: np.ndarray) -> float:
    """The ideal radius (unit focal length) at which the distorted radius stops growing; inf where never.

    The smallest positive root of d/dr (r d(r)) = 1 + 3 k1 r^2 + 5 k2 r^4 + 7 k3 r^6.
    """
    k1, k2, _, _, k3 = (float(k) for k in distortion)
    roots = np.roots([7 * k3, 5 * k2, 3 * k1, 1.0])
    real = roots.real[(abs(roots.imag) < 1e-9 * np.maximum(1.0, abs(roots))) & (roots.real > 0)]
    return float(np.sqrt(real.min())) if real.size else float("inf")


def centre(rotation: np.ndarray, translation: np.ndarray) -> np.ndarray:
    """The camera centre in the world, -R^T t; leading axes (one pose or many) are kept."""
    return -np.einsum("...ji,...j->...i", rotation, translation)


def look_at(
    eye: np.ndarray, target: np.ndarray, up: tuple[float, float, float] = (0.0, 1.0, 0.0)
) -> tuple[np.ndarray, np.ndarray]:
    """The pose (R, t) of an upright camera at `eye` that sees `target` in the middle.

    Rows of R: right = forward x up, down = forward x right, forward; t = -R eye.
    Raises ValueError where the direction is zero or along `up`.
    """
    eye = np.asarray(eye, np.float64)
    forward = np.asarray(target, np.float64) - eye
    right = np.cross(forward, np.asarray(up, np.float64))
    if not np.linalg.norm(right) > 1e-9 * np.linalg.norm(forward):
        raise ValueError(
            f"look_at: eye {eye.tolist()} and target {np.asarray(target).tolist()} must differ, and not only "
            f"along up {list(up)}: move the eye sideways or give another up"
        )
    forward = forward / np.linalg.norm(forward)
    right = right / np.linalg.norm(right)
    rotation = np.stack([right, np.cross(forward, right), forward])
    return rotation, -rotation @ eye
