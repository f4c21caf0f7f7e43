"""The part of a motion graph in which play never ends."""

from __future__ import annotations

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import connected_components


def follows(source: np.ndarray, target: np.ndarray, departure: np.ndarray, arrival: np.ndarray) -> np.ndarray:
    """Whether transition j can follow transition i, (T, T) bool: in the same take and not before i ends.

    source, target: takes left and entered; departure: first blended frame of the source, m - L; arrival: last
    blended frame of the target, n + L.
    """
    return (target[:, None] == source[None, :]) & (arrival[:, None] <= departure[None, :])


def strong_part(
    source: np.ndarray, target: np.ndarray, departure: np.ndarray, arrival: np.ndarray
) -> np.ndarray:
    """Transitions (T,) bool of the strongly connected part that plays the most captured frames; may be empty.

    From each of them every other of them can be reached, so a walk that keeps to them never dies.
    """
    if len(source) == 0:
        return np.zeros(0, bool)
    after = follows(source, target, departure, arrival)
    _, part = connected_components(scipy.sparse.csr_matrix(after), directed=True, connection="strong")
    best, most = np.zeros(len(source), bool), 0
    for label in np.unique(part):
        chosen = part == label
        if not after[np.ix_(chosen, chosen)].any():
            continue
        frames = _frames_played(chosen, source, target, departure, arrival)
        if frames > most:
            best, most = chosen, frames
    return best


def around(after: np.ndarray, core: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which transitions (T,) bool some walk of the core reaches, and from which one comes to the core.

    after: (T, T) whether transition j can follow transition i; core: (T,).
    """
    reached, returns = core.copy(), core.copy()
    for _ in range(len(core)):
        reached |= after[reached].any(axis=0)
        returns |= after[:, returns].any(axis=1)
    return reached, returns


def _frames_played(
    chosen: np.ndarray, source: np.ndarray, target: np.ndarray, departure: np.ndarray, arrival: np.ndarray
) -> int:
    total = 0
    for take in np.unique(target[chosen]):
        first = arrival[chosen & (target == take)].min()
        last = departure[chosen & (source == take)].max()
        total += int(max(last - first, 0)) + 1
    return total
