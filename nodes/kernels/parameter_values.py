"""What blends do, read from samples of the map from controls to parameters."""

from __future__ import annotations

import numpy as np
import scipy.interpolate


def values_at(controls: np.ndarray, sample_control: np.ndarray, sample_value: np.ndarray) -> np.ndarray:
    """Parameters p = f(u) (S, d) at controls u (S, d): exact at samples (K, d), linear between them.

    Beyond the samples the value of the nearest.
    """
    if len(controls) == 0:
        return np.zeros(controls.shape)
    if sample_control.shape[1] == 1:
        order = np.argsort(sample_control[:, 0], kind="stable")
        made = np.interp(controls[:, 0], sample_control[order, 0], sample_value[order, 0])
        return np.asarray(made[:, None])
    # a hair towards the middle, so that corners are not outside by rounding
    middle = sample_control.mean(axis=0)
    inside = middle + (1 - 1e-9) * (controls - middle)
    made = scipy.interpolate.LinearNDInterpolator(sample_control, sample_value)(inside)
    beyond = np.isnan(made).any(axis=1)
    nearest = scipy.interpolate.NearestNDInterpolator(sample_control, sample_value)
    made[beyond] = nearest(controls[beyond]) if beyond.any() else made[beyond]
    return np.asarray(made)
