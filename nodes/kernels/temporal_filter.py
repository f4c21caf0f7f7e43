"""Temporal filtering of matrices that compare two takes."""

from __future__ import annotations

import numpy as np


def filter_diagonals(matrix: np.ndarray, frames: int) -> np.ndarray:
    """Mean along the diagonal over `frames` entries before and after, of those that exist: same shape (Ta,
    Tb).

    S(a, b) = mean over |k| <= frames, with a + k and b + k inside, of D(a + k, b + k).
    """
    total = np.zeros(matrix.shape)
    count = np.zeros(matrix.shape)
    rows, columns = matrix.shape
    for k in range(-min(frames, min(rows, columns) - 1), min(frames, min(rows, columns) - 1) + 1):
        here = (slice(max(0, -k), rows - max(0, k)), slice(max(0, -k), columns - max(0, k)))
        there = (slice(max(0, k), rows + min(0, k)), slice(max(0, k), columns + min(0, k)))
        total[here] += matrix[there]
        count[here] += 1
    return total / count
