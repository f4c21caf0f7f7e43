"""The best time-warped transition from every frame of one sequence to every frame of another.

A transition from i to j blends a window of the source that starts at i with a window of the target that ends at j,
along a path of cells (source frame, target frame) from (i, first of the target's window) to (last of the source's
window, j). Steps go one frame on in one or both sequences, at most three in a row in one alone.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

# consecutive steps in one sequence alone
_RUN = 3
# how a cell was entered: both on, then source held 1 .. 3 times, then target held 1 .. 3 times
_WAYS = 1 + 2 * _RUN


class BestTransitions(NamedTuple):
    """Per (i, j): the sum over cells of d, the steps (cells less one) and both windows' lengths in frames."""

    deformation: np.ndarray
    duration: np.ndarray
    source_length: np.ndarray
    target_length: np.ndarray


def best_transitions(distance: np.ndarray, alpha: float, shortest: int, longest: int) -> BestTransitions:
    """The transitions of least E = D + alpha L over both windows' lengths and all paths, (Ta, Tb) each.

    distance: (Ta, Tb), not negative; alpha > 0, per step; shortest <= longest: bounds of both windows, frames.
    Where a take ends (source) or starts (target) within the shortest window, its end frame is held to fill it.

    All targets of one source frame are found in one sweep: the state of a path is its cell, how it came there and
    how long the target's window is, up to the shortest. What cannot beat a transition already found, even if
    every row to come cost its minimum, is dropped; the pure diagonal is found first. The rare optimum whose
    target window would be longer than `longest` is looked for again among its permitted starts.
    """
    matrix = np.ascontiguousarray(distance, np.float64)
    return BestTransitions(*_all(matrix, float(alpha), int(shortest), int(longest)))


def transition_path(
    distance: np.ndarray, i: int, j: int, source_length: int, target_length: int, alpha: float
) -> np.ndarray:
    """The path of the transition i to j with given windows: cells (n, 2), frames of source and target.

    Frames beyond the ends of a take are held. Raises ValueError where windows of these lengths have no path.
    """
    rows = np.minimum(i + np.arange(source_length), distance.shape[0] - 1)
    columns = np.maximum(j - target_length + 1 + np.arange(target_length), 0)
    cells = _path(np.ascontiguousarray(distance[np.ix_(rows, columns)], np.float64), float(alpha))
    if not len(cells):
        raise ValueError(
            f"windows of {source_length} and {target_length} frames cannot be warped with {_RUN} steps at most"
        )
    return np.stack([rows[cells[:, 0]], columns[cells[:, 1]]], axis=1)


@njit(cache=True, nogil=True)
def _all(
    distance: np.ndarray, alpha: float, shortest: int, longest: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    frames, others = distance.shape
    pad = shortest - 1
    width = others + pad
    deformation = np.empty((frames, others), np.float32)
    whole = np.empty((3, frames, others), np.int32)
    value, begin, cells = _scratch(width, shortest)
    least = np.empty(frames)
    for i in range(frames):
        least[i] = distance[i].min() + alpha
    best, found, again = np.empty(others), np.empty((3, others), np.int32), np.empty(others)
    refound = np.empty((3, others), np.int32)
    for i in range(frames):
        rows = max(shortest, min(longest, frames - i))
        _diagonals(distance, i, alpha, shortest, best, found)
        _sweep(distance, i, alpha, shortest, rows, 0, width, longest, least, value, begin, cells, best, found)
        for j in range(others):
            if found[1, j] > longest:
                again[j] = np.inf
                _sweep(
                    distance, i, alpha, shortest, rows, j + pad - longest + 1, j + pad + 1, longest, least,
                    value, begin, cells, again, refound,
                )  # fmt: skip
                best[j], found[:, j] = again[j], refound[:, j]
            deformation[i, j] = best[j] - alpha * found[2, j]
            whole[0, i, j] = found[2, j] - 1
            whole[1, i, j], whole[2, i, j] = found[0, j], found[1, j]
    return deformation, whole[0], whole[1], whole[2]


@njit(cache=True, nogil=True)
def _scratch(width: int, shortest: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    shape = (2, width, shortest, _WAYS)
    return np.empty(shape), np.empty(shape, np.int32), np.empty(shape, np.int32)


@njit(cache=True, nogil=True)
def _diagonals(
    distance: np.ndarray, i: int, alpha: float, shortest: int, best: np.ndarray, found: np.ndarray
) -> None:
    """Both windows as short as they may be and played at one pace: something to beat."""
    frames, others = distance.shape
    for j in range(others):
        total = 0.0
        for k in range(shortest):
            total += distance[min(i + k, frames - 1), max(j - shortest + 1 + k, 0)] + alpha
        best[j] = total
        found[:, j] = shortest


@njit(cache=True, nogil=True)
def _sweep(
    distance: np.ndarray, i: int, alpha: float, shortest: int, rows: int, low: int, high: int, longest: int,
    least: np.ndarray, value: np.ndarray, begin: np.ndarray, cells: np.ndarray, best: np.ndarray, found: np.ndarray,
) -> None:  # fmt: skip
    """Improve `best` by all paths from source frame i that start and stay in columns low .. high - 1."""
    frames, pad = distance.shape[0], shortest - 1
    last = shortest - 1
    limit = np.empty(high - low)
    value[0, low:high] = np.inf
    for r in range(rows):
        now, old = r % 2, 1 - r % 2
        source = min(i + r, frames - 1)
        rest = 0.0
        for k in range(r + 1, shortest):
            rest += least[min(i + k, frames - 1)]
        _window_maximum(best, low, high, pad, longest, limit)
        alive = False
        for c in range(low, high):
            step = distance[source, max(c - pad, 0)] + alpha
            bound = limit[c - low] - rest
            for k in range(shortest):
                for way in range(_WAYS):
                    value[now, c, k, way] = np.inf
            if r == 0 and step < bound:
                value[now, c, 0, 0], begin[now, c, 0, 0], cells[now, c, 0, 0] = step, c, 1
                alive = True
            for k in range(shortest):
                if r > 0:
                    alive |= _enter(value, begin, cells, now, c, k, 1, old, c, k, step, bound)
                if c == low:
                    continue
                if k > 0:
                    if r > 0:
                        alive |= _meet(value, begin, cells, now, c, k, old, c - 1, k - 1, step, bound)
                    alive |= _enter(value, begin, cells, now, c, k, 1 + _RUN, now, c - 1, k - 1, step, bound)
                # windows that were filled up with a held frame grow no longer
                if k == last and c - 1 >= pad + last:
                    if r > 0:
                        alive |= _meet(value, begin, cells, now, c, k, old, c - 1, k, step, bound)
                    alive |= _enter(value, begin, cells, now, c, k, 1 + _RUN, now, c - 1, k, step, bound)
            if r >= last and c >= pad:
                for way in range(_WAYS):
                    if value[now, c, last, way] < best[c - pad]:
                        best[c - pad] = value[now, c, last, way]
                        found[0, c - pad] = r + 1
                        found[1, c - pad] = c - begin[now, c, last, way] + 1
                        found[2, c - pad] = cells[now, c, last, way]
        if not alive:
            return


@njit(cache=True, nogil=True)
def _meet(
    value: np.ndarray, begin: np.ndarray, cells: np.ndarray, now: int, c: int, k: int,
    old: int, from_c: int, from_k: int, step: float, bound: float,
) -> bool:  # fmt: skip
    """A step on in both sequences; whether it may still win."""
    from_way = 0
    for way in range(1, _WAYS):
        if value[old, from_c, from_k, way] < value[old, from_c, from_k, from_way]:
            from_way = way
    total = value[old, from_c, from_k, from_way] + step
    if not (total < bound and total < value[now, c, k, 0]):
        return False
    value[now, c, k, 0] = total
    begin[now, c, k, 0] = begin[old, from_c, from_k, from_way]
    cells[now, c, k, 0] = cells[old, from_c, from_k, from_way] + 1
    return True


@njit(cache=True, nogil=True)
def _enter(
    value: np.ndarray, begin: np.ndarray, cells: np.ndarray, now: int, c: int, k: int, ways: int,
    old: int, from_c: int, from_k: int, step: float, bound: float,
) -> bool:  # fmt: skip
    """A step on in one sequence alone, ways .. ways + 2 for the first to the third in a row."""
    alive = False
    for run in range(_RUN):
        from_way = ways + run - 1
        if run == 0:
            from_way = 0
            for n in range(_RUN):
                other = (1 + _RUN if ways == 1 else 1) + n
                if value[old, from_c, from_k, other] < value[old, from_c, from_k, from_way]:
                    from_way = other
        total = value[old, from_c, from_k, from_way] + step
        if total < bound and total < value[now, c, k, ways + run]:
            value[now, c, k, ways + run] = total
            begin[now, c, k, ways + run] = begin[old, from_c, from_k, from_way]
            cells[now, c, k, ways + run] = cells[old, from_c, from_k, from_way] + 1
            alive = True
    return alive


@njit(cache=True, nogil=True)
def _window_maximum(best: np.ndarray, low: int, high: int, pad: int, longest: int, limit: np.ndarray) -> None:
    """For each column the greatest best of the ends that a path through it may still reach."""
    for c in range(low, high):
        most = 0.0
        for j in range(max(c - pad, 0), min(c - pad + longest, high - pad)):
            most = max(most, best[j])
        limit[c - low] = most


@njit(cache=True, nogil=True)
def _path(cost: np.ndarray, alpha: float) -> np.ndarray:
    """Cells (n, 2) of the cheapest permitted path from corner to corner; none where there is none."""
    rows, columns = cost.shape
    value = np.full((rows, columns, _WAYS), np.inf)
    came = np.zeros((rows, columns, _WAYS), np.int8)
    value[0, 0, 0] = cost[0, 0] + alpha
    for r in range(rows):
        for c in range(columns):
            step = cost[r, c] + alpha
            for way in range(_WAYS):
                run = 0 if way == 0 else (way - 1) % _RUN
                vertical = 1 <= way <= _RUN
                dr, dc = (1 if way == 0 or vertical else 0), (0 if vertical else 1)
                if r < dr or c < dc:
                    continue
                for before in range(_WAYS):
                    if way > 0 and run > 0 and before != way - 1:
                        continue
                    if way > 0 and run == 0 and before > 0 and (before <= _RUN) == vertical:
                        continue
                    total = value[r - dr, c - dc, before] + step
                    if total < value[r, c, way]:
                        value[r, c, way], came[r, c, way] = total, before
    way = int(np.argmin(value[rows - 1, columns - 1]))
    out = np.empty((rows + columns, 2), np.int64)
    n = 0
    if np.isfinite(value[rows - 1, columns - 1, way]):
        r, c = rows - 1, columns - 1
        while True:
            out[n, 0], out[n, 1] = r, c
            n += 1
            if r == 0 and c == 0:
                break
            before = came[r, c, way]
            r, c = r - (1 if way <= _RUN else 0), c - (0 if 1 <= way <= _RUN else 1)
            way = before
    return out[:n][::-1].copy()
