"""From where a character stands to how fast it must go and turn, so that it stays on a curve."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from reperform.nodes.kernels.bezier import GroundCurve


@njit(cache=True, nogil=True)
def nearest_ahead(point: np.ndarray, x: float, z: float, start: int, reach: int) -> int:
    """Index of the sample of a curve (N, 2) nearest to (x, z) among start .. start + reach."""
    best, index = np.inf, start
    for k in range(start, min(start + reach + 1, len(point))):
        d = (point[k, 0] - x) ** 2 + (point[k, 1] - z) ** 2
        if d < best:
            best, index = d, k
    return index


@njit(cache=True, nogil=True)
def follow(
    point: np.ndarray,
    tangent: np.ndarray,
    spacing: float,
    state: np.ndarray,
    at: int,
    look_ahead: float,
    limits: np.ndarray,
    out: np.ndarray,
) -> int:
    """Speed and turning rate that bring a character back to a curve; the sample that it has come to.

    point, tangent: the curve's samples (N, 2), N > 1, `spacing` m apart.  state: x, z, heading (rad, 0 along +z, to the left
    positive), speed now (m/s).  at: the sample of the last call.  look_ahead: s.  limits: least and greatest speed
    (m/s), greatest turning rate (rad/s), greatest acceleration across (m/s^2).  out: speed (m/s), turning rate
    (rad/s), arc length left (m).

    The curvature to go is that of the curve a little ahead, and what brings an offset e (to the left) and a wrong
    heading a back, critically damped over the length L = max(0.35 m, speed look_ahead):

        k = k_curve + 2 a / L - e / L^2,   turning = k speed

    The speed falls where the curve ahead bends, so that speed^2 k keeps to the acceleration, and speed k to 0.9 of the
    turning rate.

    Source: Coulter 1992, CMU-RI-TR-92-01 ("pure pursuit", its linearisation). Departure: the curve's own curvature is
    fed forward, so that corners are not cut.
    """
    x, z, heading, speed = state[0], state[1], state[2], state[3]
    last = len(point) - 1
    here = nearest_ahead(point, x, z, at, int(1.5 / spacing) + 1)
    ahead = max(0.35, speed * look_ahead)
    aim = min(here + max(1, round(0.3 * ahead / spacing)), last - 1)
    bend = _curvature(tangent, min(here, last - 1), aim + 1, spacing)
    offset = tangent[here, 1] * (x - point[here, 0]) - tangent[here, 0] * (z - point[here, 1])
    angle = math.atan2(tangent[here, 0], tangent[here, 1]) - heading
    angle = math.atan2(math.sin(angle), math.cos(angle))
    bend += 2.0 * angle / ahead - min(max(offset / ahead, -1.5), 1.5) / ahead
    wanted = limits[1]
    far = min(here + max(1, round(2.0 * ahead / spacing)), last)
    for k in range(here, far):
        turn = abs(_curvature(tangent, k, k + 1, spacing))
        if turn > 1e-6:
            wanted = min(wanted, math.sqrt(limits[3] / turn), 0.9 * limits[2] / turn)
    wanted = max(wanted, limits[0])
    out[0] = wanted
    out[1] = min(max(bend * max(speed, limits[0]), -limits[2]), limits[2])
    out[2] = (last - here) * spacing
    return here


@njit(cache=True, nogil=True)
def _curvature(tangent: np.ndarray, first: int, last: int, spacing: float) -> float:
    """Mean curvature between two samples, to the left positive, 1/m."""
    sine = tangent[first, 1] * tangent[last, 0] - tangent[first, 0] * tangent[last, 1]
    cosine = tangent[first, 0] * tangent[last, 0] + tangent[first, 1] * tangent[last, 1]
    return math.atan2(sine, cosine) / (max(last - first, 1) * spacing)


class Follower:
    """Follows one curve: `command(x, z, heading, speed)` gives speed and turning rate, and what is left of it."""

    def __init__(self, curve: GroundCurve, limits: np.ndarray, look_ahead: float = 0.35) -> None:
        self.curve, self.look_ahead = curve, look_ahead
        self.limits = np.asarray(limits, np.float64)
        self._point = np.ascontiguousarray(curve.point)
        self._tangent = np.ascontiguousarray(curve.tangent)
        self._spacing = curve.length / max(len(curve.point) - 1, 1)
        self._at, self._out, self._state = 0, np.zeros(3), np.zeros(4)

    def command(self, x: float, z: float, heading: float, speed: float) -> tuple[float, float, float]:
        """Speed (m/s), turning rate (rad/s, left positive) and arc length left (m)."""
        self._state[:] = x, z, heading, speed
        self._at = follow(
            self._point, self._tangent, self._spacing, self._state, self._at, self.look_ahead, self.limits, self._out
        )  # fmt: skip
        return float(self._out[0]), float(self._out[1]), float(self._out[2])
