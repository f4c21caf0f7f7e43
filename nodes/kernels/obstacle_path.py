"""Ways around obstacles that stand on the ground."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.bezier import GroundCurve, curve_of, through

_SWEEPS = 400


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
    curve: GroundCurve, obstacles: Obstacles, margin: float, spacing: float = 0.02, smooth: float = 0.45
) -> GroundCurve:
    """The curve bent so that it keeps `margin` m from every obstacle, its ends where they were.

    An elastic band: points about every 0.1 m are pulled to the straight line between their neighbours, back to the
    given curve, and pushed out along the gradient of the distance where they are nearer than the margin; what comes
    out is a chain of cubics through them. Where nothing is near, the curve stays as it is.

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
    band = _settle(rest, obstacles, margin + 0.02, smooth)
    bent = curve_of(through(band), spacing)
    least = float(clearance(obstacles, bent.point)[0].min())
    if least < margin - 0.02:
        raise ValueError(
            f"no way around the obstacles keeps {margin:g} m, the best found {least:.2f} m: draw the path past them"
        )
    return bent


def _settle(rest: np.ndarray, obstacles: Obstacles, margin: float, smooth: float) -> np.ndarray:
    band = rest.copy()
    for _ in range(_SWEEPS):
        inner = band[1:-1]
        inner += smooth * (0.5 * (band[:-2] + band[2:]) - inner)
        inner += 0.04 * (rest[1:-1] - inner)
        distance, way = clearance(obstacles, inner)
        inner += np.clip(margin - distance, 0, None)[:, None] * way
    return band
