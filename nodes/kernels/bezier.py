"""Chains of cubic Bezier curves on the ground, by arc length."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import roots_legendre

# Gauss-Legendre points per piece: arc lengths are exact to about 1e-9 of the length of a piece.
_GAUSS = 8
_PIECES = 64


class GroundCurve(NamedTuple):
    """A curve (N, 2) of columns x, z sampled at equal arc length, with its unit tangents and lengths, m."""

    point: np.ndarray
    tangent: np.ndarray
    arc: np.ndarray

    @property
    def length(self) -> float:
        """Length, m."""
        return float(self.arc[-1])


def bezier_points(controls: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Points at t in [0, n] of a chain of n cubics with controls (3 n + 1, 2): (1-t)^3 a + 3 (1-t)^2 t b + ..."""
    a, b, c, d, u = _pieces(controls, t)
    v = 1.0 - u
    return v**3 * a + 3 * v * v * u * b + 3 * v * u * u * c + u**3 * d


def bezier_velocity(controls: np.ndarray, t: np.ndarray) -> np.ndarray:
    """d point / dt at t in [0, n]."""
    a, b, c, d, u = _pieces(controls, t)
    v = 1.0 - u
    return 3 * (v * v * (b - a) + 2 * v * u * (c - b) + u * u * (d - c))


def _pieces(controls: np.ndarray, t: np.ndarray) -> tuple[np.ndarray, ...]:
    count = (len(controls) - 1) // 3
    t = np.asarray(t, np.float64)
    piece = np.clip(np.floor(t).astype(int), 0, count - 1)
    u = (t - piece)[..., None]
    return (*(controls[3 * piece + k] for k in range(4)), u)


def curve_of(controls: np.ndarray, spacing: float = 0.02) -> GroundCurve:
    """The chain of cubics sampled about every `spacing` m of arc length, both ends included.

    s(t) = integral of |dp/dt| by Gauss-Legendre on pieces, inverted by interpolation and two Newton steps.
    Raises ValueError where there are not 3 n + 1 finite controls, or where the curve has no length.

    Source: Bezier curves by de Casteljau 1959 in Bernstein form; arc length: Guenter and Parent 1990, IEEE CG&A 10.
    """
    controls = np.asarray(controls, np.float64)
    if controls.ndim != 2 or controls.shape[1] != 2 or len(controls) < 4 or len(controls) % 3 != 1:
        raise ValueError(f"a chain of cubic curves needs 3 n + 1 controls (x, z), got shape {controls.shape}")
    if not np.isfinite(controls).all():
        raise ValueError("the controls of a curve must be finite, in m")
    count = (len(controls) - 1) // 3
    knots = np.linspace(0, count, count * _PIECES + 1)
    at, weight = roots_legendre(_GAUSS)
    half = 0.5 * np.diff(knots)
    samples = 0.5 * (knots[1:] + knots[:-1])[:, None] + half[:, None] * at
    arc = np.concatenate([[0], np.cumsum(half * (_speed(controls, samples) @ weight))])
    if not arc[-1] > 1e-6:
        raise ValueError("a curve must have a length, got one point: move its controls apart")
    wanted = np.linspace(0, arc[-1], max(int(np.ceil(arc[-1] / spacing)), 1) + 1)
    t = _times(controls, knots, arc, wanted, at, weight)
    velocity = bezier_velocity(controls, t)
    speed = np.linalg.norm(velocity, axis=1)
    points = bezier_points(controls, t)
    chord = np.gradient(points, axis=0)
    direction = np.where((speed > 1e-9)[:, None], velocity, chord)
    tangent = direction / np.maximum(np.linalg.norm(direction, axis=1), 1e-12)[:, None]
    return GroundCurve(points, tangent, wanted)


def _speed(controls: np.ndarray, t: np.ndarray) -> np.ndarray:
    return np.asarray(np.linalg.norm(bezier_velocity(controls, t), axis=-1))


def _times(
    controls: np.ndarray, knots: np.ndarray, arc: np.ndarray, wanted: np.ndarray, at: np.ndarray, weight: np.ndarray
) -> np.ndarray:  # fmt: skip
    t = np.interp(wanted, arc, knots)
    for _ in range(2):
        piece = np.clip(np.searchsorted(knots, t, side="right") - 1, 0, len(knots) - 2)
        half = 0.5 * (t - knots[piece])
        samples = knots[piece][:, None] + half[:, None] * (1 + at)
        reached = arc[piece] + half * (_speed(controls, samples) @ weight)
        t = np.clip(t - (reached - wanted) / np.maximum(_speed(controls, t), 1e-6), 0, knots[-1])
    return t


def through(points: np.ndarray) -> np.ndarray:
    """Controls of a smooth chain of cubics through points (N, 2), N >= 2: centripetal tangents.

    Source: Catmull and Rom 1974; Yuksel, Schaefer and Keyser 2011, CAD 43 (centripetal: no loops).
    """
    points = np.asarray(points, np.float64)
    gap = np.sqrt(np.maximum(np.linalg.norm(np.diff(points, axis=0), axis=1), 1e-9))
    slope = np.diff(points, axis=0) / gap[:, None]
    tangent = np.empty_like(points)
    tangent[0], tangent[-1] = slope[0], slope[-1]
    if len(points) > 2:
        before, after = gap[:-1, None], gap[1:, None]
        tangent[1:-1] = (after * slope[:-1] + before * slope[1:]) / (before + after)
    controls = np.empty((3 * len(points) - 2, 2))
    controls[::3] = points
    controls[1::3] = points[:-1] + tangent[:-1] * gap[:, None] / 3
    controls[2::3] = points[1:] - tangent[1:] * gap[:, None] / 3
    return controls


def polyline_distance(points: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Distance (T,) of ground places (T, 2) to the polyline through points (N, 2), N > 1, m."""
    a, b = points[:-1], points[1:]
    along = b - a
    square = np.maximum((along * along).sum(1), 1e-18)
    out = np.empty(len(places))
    for k, place in enumerate(np.asarray(places, np.float64)):
        share = np.clip(((place - a) * along).sum(1) / square, 0, 1)
        out[k] = np.sqrt(((a + share[:, None] * along - place) ** 2).sum(1).min())
    return out
