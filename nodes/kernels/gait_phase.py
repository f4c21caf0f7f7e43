"""Where in the cycle of steps a walker is, from its contacts with the ground."""

from __future__ import annotations

import numpy as np


def gait_phase(planted: np.ndarray) -> np.ndarray:
    """Phase (T,) in cycles, not wrapped, of planted (T, 2): whole where the left foot comes down, half where the
    right does.

    Linear between landings and at the pace of the nearest step before the first and after the last. nan where
    fewer than two landings are seen.
    """
    landed = planted[1:] & ~planted[:-1]
    frame, foot = np.nonzero(landed)
    # one landing after another on alternate feet
    keep = np.ones(len(frame), bool)
    keep[1:] = foot[1:] != foot[:-1]
    frame, foot = frame[keep] + 1, foot[keep]
    time = np.arange(len(planted))
    if len(frame) < 2:
        return np.full(len(planted), np.nan)
    phase = 0.5 * foot[0] + 0.5 * np.arange(len(frame))
    inside = np.interp(time, frame, phase)
    early, late = 0.5 / (frame[1] - frame[0]), 0.5 / (frame[-1] - frame[-2])
    inside[time < frame[0]] = phase[0] - early * (frame[0] - time[time < frame[0]])
    inside[time > frame[-1]] = phase[-1] + late * (time[time > frame[-1]] - frame[-1])
    return inside
