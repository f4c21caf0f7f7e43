"""Which feet rest while a path through captured takes is played."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reperform.nodes.kernels.path_mean import path_mean


def path_contacts(
    take: np.ndarray, frame: np.ndarray, weight: np.ndarray, planted: Sequence[np.ndarray], share: float = 1.0
) -> np.ndarray:
    """(F, K) bool: the feet that rest in sources of at least `share` of the weight; at 1 in all that count.

    take, frame, weight (F, 2): provenance of each played frame, takes by number; planted: per take (T, K).
    """
    return np.asarray(path_mean(take, frame, weight, planted) >= share - 1e-4)
