"""Temporal filtering of matrices that compare two takes."""

from __future__ import annotations

import numpy as np
from numba import njit


def filter_diagonals(matrix: np.ndarray, frames: int) -> np.ndarray:
    """Mean along the diagonal over `frames` entries before and after, of those that exist: same shape (Ta,
    Tb).

    S(a, b) = mean over |k| <= frames, with a + k and b + k inside, of D(a + k, b + k).
    """
    weights = np.ones(2 * frames + 1)
    return sum_diagonals(matrix, weights) / sum_diagonals(np.ones(matrix.shape), weights)


def sum_diagonals(matrix: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """S(a, b) = sum over |k| <= n, with a + k and b + k inside, of weights[n + k] D(a + k, b + k); weights (2 n +
    1,).
    """
    total = np.zeros(matrix.shape)
    rows, columns = matrix.shape
    frames = len(weights) // 2
    reach = min(frames, min(rows, columns) - 1)
    for k in range(-reach, reach + 1):
        here = (slice(max(0, -k), rows - max(0, k)), slice(max(0, -k), columns - max(0, k)))
        there = (slice(max(0, k), rows + min(0, k)), slice(max(0, k), columns + min(0, k)))
        total[here] += weights[frames + k] * matrix[there]
    return total


@njit(cache=True, nogil=True)
def filter_adaptively(matrix: np.ndarray, shortest: int, longest: int) -> tuple[np.ndarray, np.ndarray]:
    """The least windowed mean over half lengths shortest .. longest (frames, >= 1), and that half length: both
    (Ta, Tb).

        S(a, b) = min over L of sum_k (L - |k|) D(a + k, b + k) / sum_k (L - |k|),   |k| < L

    over the k with a + k and b + k inside.
    """
    rows, columns = matrix.shape
    least = np.full((rows, columns), np.inf)
    length = np.zeros((rows, columns), np.int32)
    for r in range(rows):
        for c in range(columns):
            box, count, total, weight = matrix[r, c], 1.0, 0.0, 0.0
            for half in range(1, longest + 1):
                # the triangle of half length L is the sum of the boxes of radius 0 .. L - 1
                k = half - 1
                if k > 0 and r >= k and c >= k:
                    box += matrix[r - k, c - k]
                    count += 1
                if k > 0 and r + k < rows and c + k < columns:
                    box += matrix[r + k, c + k]
                    count += 1
                total += box
                weight += count
                if half >= shortest and total / weight < least[r, c]:
                    least[r, c] = total / weight
                    length[r, c] = half
    return least, length
