"""Gains that bring the colours of cameras together, from what they see of the same surface points."""

from __future__ import annotations

import numpy as np


def colour_gain(
    colours: np.ndarray, weights: np.ndarray, *, rounds: int = 8, spread: float = 0.15
) -> np.ndarray:
    """Factors (C, 3) on the channels of C cameras, from colours (C, N, 3), 0..255, and weights (C, N) >= 0.

    Per channel minimise over log gains g and log surface colours m
    sum_{c,n} w_cn rho(log I_cn + g_c - m_n),  rho of Cauchy with scale `spread`, by reweighting; m is
    eliminated: A = sum_n diag(w_n) - w_n w_n^T / sum(w_n). Of the solutions (they are free up to a common
    factor per group of cameras that share points) the one whose median log gain is 0: a lone off-colour
    camera does not shift the rest. Values under 6 or over 249 (dark or clipped) do not count; a camera that
    shares no point keeps gain 1.

    Source: Cauchy reweighting: Holland and Welsch 1977; gain compensation: Brown and Lowe 2007, IJCV 74(1).
    Departure: on surface points seen by several cameras, not on overlapping pictures.
    """
    count = len(colours)
    gains = np.zeros((count, 3))
    for channel in range(3):
        value = colours[..., channel].astype(np.float64)
        usable = (weights > 0) & (value > 6) & (value < 249)
        usable &= usable.sum(axis=0) > 1
        logs = np.log(np.where(usable, value, 1.0))
        shared = usable.any(axis=1)
        gain = np.zeros(count)
        robust = np.where(usable, weights, 0.0)
        for _ in range(rounds):
            gain = _solve(logs, robust)
            gain[shared] -= np.median(gain[shared]) if shared.any() else 0.0
            gain[~shared] = 0.0
            corrected = logs + gain[:, None]
            total = np.maximum(robust.sum(axis=0), 1e-12)
            residual = corrected - (robust * corrected).sum(axis=0) / total
            robust = np.where(usable, weights / (1 + np.square(residual / spread)), 0.0)
        gains[:, channel] = gain
    return np.exp(gains)


def _solve(logs: np.ndarray, weights: np.ndarray) -> np.ndarray:
    total = np.maximum(weights.sum(axis=0), 1e-12)
    system = np.diag(weights.sum(axis=1)) - (weights / total) @ weights.T
    mean = (weights * logs).sum(axis=0) / total
    right = (weights * (mean - logs)).sum(axis=1)
    return np.linalg.lstsq(system, right, rcond=1e-9)[0]
