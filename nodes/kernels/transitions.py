"""Finding where one sequence may pass into another, from the matrix of their frame-to-frame dissimilarity."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit


class Transitions(NamedTuple):
    """Transitions of an ordered pair, best first: from frame m of one to n of the other, half length L."""

    m: np.ndarray
    n: np.ndarray
    length: np.ndarray
    cost: np.ndarray


def find_transitions(
    distance: np.ndarray, count: int, shortest: int, longest: int, *, apart: int = 0, spread: int = 1
) -> Transitions:
    """The `count` best transitions (m, n, L) by the windowed cost, among its local minima.

    distance: (frames_a, frames_b) dissimilarity.  shortest, longest: bounds of the half length L, frames.
    apart: with one sequence on both sides, the least |m - n|.  spread: kept transitions differ by at least
    that many frames in m or in n.

        W_L(m, n) = sum_k (L - |k|) c(m + k, n + k) / L^2,   |k| <= L,  all of the window inside both
        sequences

    Local minima are those of W at the shortest L among its eight neighbours (those at least `apart`); then
    the best L is taken for each.

    Source: Huang, Tejera, Collomosse and Hilton 2015, ACM TOG (000 eqs 2-5).
    Departure: the sum is divided by the sum of its weights, else the shortest window always wins.
    """
    matrix = np.ascontiguousarray(distance, np.float64)
    none = np.zeros(0, np.int32)
    if count < 1 or min(matrix.shape) < 2 * shortest + 1:
        return Transitions(none, none, none, np.zeros(0))
    m, n = _local_minima(windowed_cost(matrix, shortest), shortest, apart)
    length, cost = _best_lengths(matrix, m, n, shortest, longest)
    order = np.argsort(cost, kind="stable")
    kept: list[int] = []
    for i in order:
        if all(abs(m[i] - m[j]) >= spread or abs(n[i] - n[j]) >= spread for j in kept):
            kept.append(int(i))
            if len(kept) == count:
                break
    return Transitions(m[kept], n[kept], length[kept], cost[kept])


def window_cost(distance: np.ndarray, m: int, n: int, half: int) -> float:
    """W at one cell and half length; the window must fit."""
    window = np.arange(1 - half, half)
    return float((half - np.abs(window)) @ distance[m + window, n + window]) / half**2


@njit(cache=True, nogil=True)
def windowed_cost(distance: np.ndarray, half: int) -> np.ndarray:
    """W at one half length for all cells (frames_a, frames_b); inf where the window does not fit."""
    rows, columns = distance.shape
    out = np.full((rows, columns), np.inf)
    for r in range(half, rows - half):
        for c in range(half, columns - half):
            total = 0.0
            for k in range(-half + 1, half):
                total += (half - abs(k)) * distance[r + k, c + k]
            out[r, c] = total / (half * half)
    return out


@njit(cache=True, nogil=True)
def _local_minima(cost: np.ndarray, half: int, apart: int) -> tuple[np.ndarray, np.ndarray]:
    rows, columns = cost.shape
    m, n = [0 for _ in range(0)], [0 for _ in range(0)]
    for r in range(half, rows - half):
        for c in range(half, columns - half):
            if abs(r - c) < apart:
                continue
            least = True
            for dr in range(-1, 2):
                for dc in range(-1, 2):
                    i, j = r + dr, c + dc
                    if (dr == 0 and dc == 0) or i < 0 or j < 0 or i >= rows or j >= columns:
                        continue
                    # cells that may not be chosen do not hide those beside them
                    if abs(i - j) < apart:
                        continue
                    # of equal neighbours the first one in row order counts
                    if cost[i, j] < cost[r, c] or (cost[i, j] == cost[r, c] and (i, j) < (r, c)):
                        least = False
            if least:
                m.append(r)
                n.append(c)
    return np.array(m, np.int32), np.array(n, np.int32)


@njit(cache=True, nogil=True)
def _best_lengths(
    distance: np.ndarray, m: np.ndarray, n: np.ndarray, shortest: int, longest: int
) -> tuple[np.ndarray, np.ndarray]:
    rows, columns = distance.shape
    lengths, costs = np.zeros(len(m), np.int32), np.zeros(len(m))
    for i in range(len(m)):
        r, c = m[i], n[i]
        room = min(min(r, c), min(rows - 1 - r, columns - 1 - c))
        box, triangle, best = 0.0, 0.0, np.inf
        for half in range(1, min(longest, room) + 1):
            # triangle of half length L = sum of the boxes of radius 0 .. L - 1
            k = half - 1
            box += distance[r, c] if k == 0 else distance[r - k, c - k] + distance[r + k, c + k]
            triangle += box
            value = triangle / (half * half)
            if half >= shortest and value < best:
                best = value
                lengths[i], costs[i] = half, value
    return lengths, costs
