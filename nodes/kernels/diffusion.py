"""Values on a graph, smoothed towards given ones."""

from __future__ import annotations

import numpy as np
import scipy.sparse


def diffuse(
    target: np.ndarray,
    weight: np.ndarray,
    adjacency: scipy.sparse.csr_matrix,
    *,
    smooth: float,
    keep: float,
    rounds: int,
) -> np.ndarray:
    """Values u (V,) near the least of sum_v weight (u - target)^2 + keep u^2 + smooth sum_edges (u_v - u_w)^2.

    target, weight >= 0 (V,); adjacency (V, V) of ones. `rounds` Jacobi steps from the target (0 where it has no
    weight): a value is heard at most `rounds` edges away. Loose vertices without weight become 0.

    Source: Saad 2003, Iterative Methods for Sparse Linear Systems, section 4.1.
    """
    pull = weight * target
    total = np.maximum(weight + keep + smooth * np.asarray(adjacency.sum(axis=1)).ravel(), 1e-12)
    values = np.where(weight > 0, target, 0.0)
    for _ in range(rounds):
        values = (pull + smooth * (adjacency @ values)) / total
    return values
