"""What a path's sources say of each played frame, by their weights."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def path_mean(
    take: np.ndarray, frame: np.ndarray, weight: np.ndarray, values: Sequence[np.ndarray]
) -> np.ndarray:
    """(F, ...): the weighted mean over the sources of what is known of every captured frame.

    take, frame, weight (F, 2): provenance of each played frame, takes by number; values: per take (T, ...).
    """
    out = np.zeros((len(take), *values[0].shape[1:]))
    for number, known in enumerate(values):
        for side in range(take.shape[1]):
            rows = np.flatnonzero((take[:, side] == number) & (weight[:, side] > 0.0))
            share = weight[rows, side].reshape(-1, *[1] * (known.ndim - 1))
            out[rows] += share * known[frame[rows, side]]
    return out
