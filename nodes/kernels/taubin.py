"""Smoothing that does not shrink."""

from __future__ import annotations

import numpy as np
import scipy.sparse


def taubin_smooth(
    vertices: np.ndarray, faces: np.ndarray, iterations: int, forward: float = 0.5, backward: float = -0.53
) -> np.ndarray:
    """Vertices (V, 3) after `iterations` pairs of steps v += f (mean of neighbours - v), f forward then backward.

    Passes frequencies below 1/forward + 1/backward (0.11 of the umbrella operator's spectrum of 0 .. 2).
    Source: Taubin 1995, SIGGRAPH, "A signal processing approach to fair surface design".
    """
    if iterations == 0:
        return vertices
    count = len(vertices)
    rows = faces.ravel()
    columns = faces[:, [1, 2, 0]].ravel()
    link = scipy.sparse.coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(count, count)).tocsr()
    link = link + link.T
    link.data[:] = 1.0
    mean = scipy.sparse.diags(1 / np.maximum(np.asarray(link.sum(axis=1)).ravel(), 1)) @ link
    for _ in range(iterations):
        for factor in (forward, backward):
            vertices = vertices + factor * (mean @ vertices - vertices)
    return vertices
