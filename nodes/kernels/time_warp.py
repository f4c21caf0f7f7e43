"""Bringing two sequences into step: the shortest path over their dissimilarities, and a smooth warp along it."""

from __future__ import annotations

import numpy as np
from numba import njit
from scipy.optimize import isotonic_regression

# how much a bend of the warp counts against leaving the path (frames^2 per frame^2)
_BEND = 4.0
# share of the straight line in every piece, so that time never stands still
_STRAIGHT = 0.05


def shortest_warp(distance: np.ndarray, keys: np.ndarray) -> tuple[np.ndarray, float]:
    """The path (steps, 2) of least sum of dissimilarities from corner to corner, and its mean dissimilarity.

    distance: (n, m) >= 0. keys: (K, 2) int cells that the path must pass, both columns rising.
    Steps go one on in either sequence or in both: D(i, j) = d(i, j) + min(D(i-1, j-1), D(i-1, j), D(i, j-1)).
    Raises ValueError where keys do not rise within the matrix.

    Source: 001 and 004 section 3.2.1 (fig 3.1: Dijkstra; this graph has no cycles, so one sweep does).
    """
    n, m = distance.shape
    stops = np.concatenate([[[0, 0]], np.asarray(keys, np.int64).reshape(-1, 2), [[n - 1, m - 1]]])
    if (np.diff(stops, axis=0) < 0).any():
        listed = ", ".join(f"{i}:{j}" for i, j in np.asarray(keys).tolist())
        raise ValueError(
            f"time_warp: key frames must rise in both takes within 0 .. {n - 1} and 0 .. {m - 1}, got {listed}"
        )
    pieces: list[np.ndarray] = []
    for (i, j), (p, q) in zip(stops[:-1].tolist(), stops[1:].tolist(), strict=True):
        block = np.ascontiguousarray(distance[i : p + 1, j : q + 1], np.float64)
        pieces.append(_shortest(block)[1 if pieces else 0 :] + [i, j])
    path = np.concatenate(pieces)
    return path, float(distance[path[:, 0], path[:, 1]].mean())


@njit(cache=True, nogil=True)
def _shortest(distance: np.ndarray) -> np.ndarray:
    n, m = distance.shape
    total, step = np.empty((n, m)), np.zeros((n, m), np.int8)
    for i in range(n):
        for j in range(m):
            best, how = np.inf, 0
            if i == 0 and j == 0:
                best = 0.0
            # of equal ways the diagonal is taken
            if i > 0 and j > 0 and total[i - 1, j - 1] < best:
                best, how = total[i - 1, j - 1], 3
            if i > 0 and total[i - 1, j] < best:
                best, how = total[i - 1, j], 1
            if j > 0 and total[i, j - 1] < best:
                best, how = total[i, j - 1], 2
            total[i, j] = best + distance[i, j]
            step[i, j] = how
    path = np.empty((n + m, 2), np.int64)
    i, j, count = n - 1, m - 1, 0
    while True:
        path[count, 0], path[count, 1] = i, j
        count += 1
        how = step[i, j]
        if how == 0:
            break
        i -= how & 1
        j -= how >> 1
    return path[:count][::-1].copy()


def continuous_warp(path: np.ndarray, keys: np.ndarray) -> np.ndarray:
    """Frame of the second sequence (n,) for every frame of the first: monotone, through ends and keys exactly.

    Between two keys the middle of the path is followed by the g that minimises
    sum (g_i - path_i)^2 + 4 sum (g_i-1 - 2 g_i + g_i+1)^2, made monotone by isotonic regression.

    Departure: 001 leaves the frame-to-frame steps of the path, at which time would stand still or jump.
    """
    n, m = path[-1] + 1
    count = np.bincount(path[:, 0], minlength=n)
    middle = np.bincount(path[:, 0], weights=path[:, 1], minlength=n) / count
    stops = np.concatenate([[[0, 0]], np.asarray(keys, np.int64).reshape(-1, 2), [[n - 1, m - 1]]])
    warp = middle.copy()
    for (i, j), (p, q) in zip(stops[:-1].tolist(), stops[1:].tolist(), strict=True):
        if p > i:
            warp[i : p + 1] = _smooth(middle[i : p + 1], float(j), float(q))
    return warp


def _smooth(middle: np.ndarray, first: float, last: float) -> np.ndarray:
    """One piece of the warp between two keys."""
    n = len(middle)
    straight = np.linspace(first, last, n)
    if n < 3:
        return straight
    bend = np.diff(np.eye(n), n=2, axis=0)
    matrix = np.eye(n) + _BEND * bend.T @ bend
    inner = slice(1, n - 1)
    known = matrix[inner, 0] * first + matrix[inner, -1] * last
    out = straight.copy()
    out[inner] = np.linalg.solve(matrix[inner, inner], middle[inner] - known)
    out = np.clip(isotonic_regression(out).x, first, last)
    out = (1 - _STRAIGHT) * out + _STRAIGHT * straight
    out[0], out[-1] = first, last
    return np.asarray(out)


@njit(cache=True, nogil=True)
def warped_distance(distance: np.ndarray) -> float:
    """Mean dissimilarity of a take (n frames) from the part of another that follows it best: (n, m) matrix.

    The other take is run through in a circle from any frame, at half to twice the pace:
    D(i, j) = min(D(i-1, j-1) + d, D(i-1, j-2) + d, D(i-2, j-1) + 2 d), d = d(i, j), free at both ends.

    Source: Müller 2007, Information Retrieval for Music and Motion, section 4.4 (subsequence time warping).
    """
    n, m = distance.shape
    total = np.empty((n, m))
    total[0] = distance[0]
    for i in range(1, n):
        for j in range(m):
            d = distance[i, j]
            best = min(total[i - 1, j - 1], total[i - 1, j - 2]) + d
            if i > 1:
                best = min(best, total[i - 2, j - 1] + 2.0 * d)
            total[i, j] = best
    return total[n - 1].min() / n
