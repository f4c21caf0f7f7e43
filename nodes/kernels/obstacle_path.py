"""Ways around obstacles that stand on the ground."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.bezier import GroundCurve, curve_of, through

# Bending stiffness at first, in units of the spacing, falling to a thousandth; pull back to the given curve; rounds.
_STIFF, _TETHER, _ROUNDS, _SWEEPS = 3000.0, 1e-4, 12, 40


class Obstacles(NamedTuple):
    """Circles (N, 3): x, z, radius; boxes (M, 5): x, z, half width, half depth, yaw. Metres, radians."""

    circles: np.ndarray = np.zeros((0, 3))
    boxes: np.ndarray = np.zeros((0, 5))


def clearance(obstacles: Obstacles, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Signed distance (N,) of ground places (N, 2) to the nearest obstacle, m, and the unit way out of it (N, 2).

    Negative inside; infinite without obstacles. The distance to a box is the Euclidean one, rounded at corners.
    """
    best = np.full(len(places), np.inf)
    way = np.zeros((len(places), 2))
    for x, z, radius in obstacles.circles:
        offset = places - (x, z)
        length = np.linalg.norm(offset, axis=1)
        out = np.where(length[:, None] > 1e-9, offset / np.maximum(length, 1e-9)[:, None], (1.0, 0.0))
        _keep_nearer(best, way, length - radius, out)
    for x, z, half_width, half_depth, yaw in obstacles.boxes:
        turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
        _keep_nearer(best, way, *_box(places - (x, z), turn, np.array([half_width, half_depth])))
    return best, way


def _box(offset: np.ndarray, turn: np.ndarray, half: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    local = offset @ turn.T
    side = np.where(local < 0, -1.0, 1.0)
    over = np.abs(local) - half
    outside = np.maximum(over, 0)
    length = np.linalg.norm(outside, axis=1)
    nearest = np.eye(2)[over.argmax(axis=1)]
    out = np.where((length > 1e-12)[:, None], outside / np.maximum(length, 1e-12)[:, None], nearest)
    distance = np.where(length > 1e-12, length, over.max(axis=1))
    return distance, (side * out) @ turn


def _keep_nearer(best: np.ndarray, way: np.ndarray, distance: np.ndarray, out: np.ndarray) -> None:
    nearer = distance < best
    best[nearer], way[nearer] = distance[nearer], out[nearer]


def around_obstacles(
    curve: GroundCurve, obstacles: Obstacles, margin: float, spacing: float = 0.02
) -> GroundCurve:
    """The curve bent so that it keeps `margin` m from every obstacle, its ends where they were.

    An elastic band: points about every 0.1 m are pushed out sideways where they are nearer than the margin, and what
    they were pushed is smoothed by its bending, in turn; what comes out is a chain of cubics through them. Where
    nothing is near, the curve stays as it is.

    Raises ValueError where an end is nearer than the margin, or no way is found.

    Source: Quinlan and Khatib 1993, ICRA ("Elastic bands"); the seeds draw paths by hand (004 section 4.5.1).
    """
    count = max(round(curve.length / 0.1), 8)
    rest = np.column_stack(
        [np.interp(np.linspace(0, curve.length, count + 1), curve.arc, curve.point[:, k]) for k in range(2)]
    )
    distance, _ = clearance(obstacles, rest[[0, -1]])
    if (distance < margin).any():
        raise ValueError(
            f"a path's ends must be {margin:g} m or more from every obstacle, got {distance.min():.2f} m: "
            f"move the end or the obstacle"
        )
    if not (clearance(obstacles, curve.point)[0] < margin).any():
        return curve
    band = _settle(rest, obstacles, margin + 0.02)
    bent = curve_of(through(band), spacing)
    least = float(clearance(obstacles, bent.point)[0].min())
    if least < margin - 0.02:
        raise ValueError(
            f"no way around the obstacles keeps {margin:g} m, the best found {least:.2f} m: draw the path past them"
        )
    return bent


def _settle(rest: np.ndarray, obstacles: Obstacles, margin: float) -> np.ndarray:
    """Points (N, 2) pushed out in turn with smoothing of how far they were pushed, less and less of it."""
    count = len(rest)
    bend = np.diff(np.eye(count), 2, axis=0)
    stiff = bend.T @ bend
    shift = np.zeros_like(rest)
    for stiffness in np.geomspace(_STIFF, _STIFF / 1000, _ROUNDS):
        smooth = np.linalg.inv(stiffness * stiff[1:-1, 1:-1] + (1 + _TETHER) * np.eye(count - 2))
        for _ in range(_SWEEPS):
            shift[1:-1] = smooth @ shift[1:-1]
            shift[1:-1] += _push(rest + shift, obstacles, margin)
    return rest + shift


def _push(band: np.ndarray, obstacles: Obstacles, margin: float) -> np.ndarray:
    """How inner points that are too near must move. Sideways only: along the path, points would part and leave
    the obstacle between them."""
    distance, way = clearance(obstacles, band[1:-1])
    along = band[2:] - band[:-2]
    across = np.column_stack([along[:, 1], -along[:, 0]])
    across /= np.maximum(np.linalg.norm(across, axis=1), 1e-9)[:, None]
    part = (way * across).sum(axis=1)
    part = np.where(part < 0, -1.0, 1.0) / np.maximum(np.abs(part), 0.7)
    return (np.clip(margin - distance, 0, None) * part)[:, None] * across
