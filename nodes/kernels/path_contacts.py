"""Which feet rest while a path through captured takes is played."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def path_contacts(
    take: np.ndarray, frame: np.ndarray, weight: np.ndarray, planted: Sequence[np.ndarray], share: float = 1.0
) -> np.ndarray:
    """(F, K) bool: the feet that rest in sources of at least `share` of the weight; at 1 in all that count.

    take, frame, weight (F, 2): provenance of each played frame, takes by number; planted: per take (T, K).
    """
    feet = planted[0].shape[1]
    out = np.zeros((len(take), feet))
    for number, rests in enumerate(planted):
        for side in range(take.shape[1]):
            rows = np.flatnonzero((take[:, side] == number) & (weight[:, side] > 0.0))
            out[rows] += weight[rows, side, None] * rests[frame[rows, side]]
    return np.asarray(out >= share - 1e-4)
