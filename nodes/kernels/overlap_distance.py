"""How far two surfaces are apart where one take passes into another."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from reperform.nodes.kernels.ground_plane import apply
from reperform.nodes.kernels.path_frames import Passage


def hausdorff(a: np.ndarray, b: np.ndarray) -> float:
    """Greatest distance from a point of either set (N, 3), (M, 3) to the nearest of the other, m."""
    there, _ = cKDTree(b).query(a)
    back, _ = cKDTree(a).query(b)
    return float(max(there.max(), back.max()))


def overlap_distance(passage: Passage, takes: Sequence[np.ndarray], samples: int) -> float:
    """Weighted mean over a transition of the Hausdorff distance of source and placed target, m.

        sum_k a'(k) H(X_s(m + k), X_t(n + k)) / sum_k a'(k),   a'(k) = min(1 - a, a),  a = (k + L) / 2 L

    takes: vertices (frames, V, 3) of each take, m; samples: frames k at most, evenly over -L .. L (the ends weigh
    nothing).

    Source: Huang, Tejera, Collomosse and Hilton 2015, ACM TOG (000 section 6.1, weights of eq 2).
    Departure: the target lies on the source by the transition's ground-plane placement.
    """
    half = passage.length
    k = np.unique(np.linspace(1 - half, half - 1, min(samples, 2 * half - 1)).round().astype(int))
    weight = (half - np.abs(k)).astype(np.float64)
    source, target = takes[passage.source], takes[passage.target]
    apart = [
        hausdorff(
            np.asarray(source[passage.m + j]), apply(np.asarray(target[passage.n + j]), passage.placement)
        )
        for j in k.tolist()
    ]
    return float(weight @ np.array(apart) / weight.sum())
