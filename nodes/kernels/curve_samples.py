"""Smooth curves through points on the ground, sampled at even steps of arc length."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

# Points per span between two given points from which arc length is measured.
_FINE = 400


def curve_samples(points: np.ndarray, step: float, beyond: float) -> tuple[np.ndarray, float]:
    """Samples (M, 2) of the natural cubic spline through points (N, 2), every `step` m, and its length, m.

    The spline is over chord length; the samples go on straight for `beyond` m. Two points make a straight line.
    Raises ValueError where there are fewer than two points, or two in a row are one.
    """
    points = np.asarray(points, np.float64)
    gaps = np.linalg.norm(np.diff(points, axis=0), axis=1) if len(points) > 1 else np.zeros(0)
    if points.ndim != 2 or points.shape[1] != 2 or len(gaps) < 1 or gaps.min() < 1e-6:
        raise ValueError(
            f"curve: at least two points (x, z) in metres, each apart from the one before, are needed, got {points.tolist()}"
        )
    chord = np.concatenate([[0.0], np.cumsum(gaps)])
    spline = CubicSpline(chord, points, bc_type="natural")
    fine = spline(np.linspace(0.0, chord[-1], _FINE * len(gaps) + 1))
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(fine, axis=0), axis=1))])
    length = float(arc[-1])
    way = fine[-1] - fine[-2]
    fine = np.concatenate([fine, fine[-1:] + way / np.linalg.norm(way) * (beyond + step)])
    arc = np.append(arc, length + beyond + step)
    at = step * np.arange(int((length + beyond) / step) + 1)
    return np.column_stack([np.interp(at, arc, fine[:, k]) for k in range(2)]), length
