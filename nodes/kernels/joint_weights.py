"""Weights of named joints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np


def joint_weights(who: str, names: Sequence[str], given: Mapping[str, float]) -> np.ndarray:
    """Weights (joint,): 1 where none is given. Raises ValueError, in the name of `who`, where a joint does not
    exist, a weight is negative or none is left.
    """
    unknown = sorted(set(given) - set(names))
    if unknown:
        raise ValueError(f"{who}: no joint {', '.join(unknown)}; there are {', '.join(names)}")
    weights = np.array([float(given.get(name, 1.0)) for name in names])
    if not ((weights >= 0).all() and weights.sum() > 0):
        raise ValueError(f"{who}: weights of joints must be >= 0 and one positive, got {dict(given)}")
    return weights
