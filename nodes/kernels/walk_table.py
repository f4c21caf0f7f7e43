"""The loops over the table of walks: time by distance by place."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from reperform.nodes.kernels.walk_moves import Moves, Targets

# no walk
NONE = 255


class WalkTable(NamedTuple):
    """What is known of the walks that leave a state with t steps and d cells to go.

    choice (states, steps, cells): the move that starts the cheapest, 255 where there is no walk; cells low ..
    high hold values. least, slack (states, steps): least cost, and greatest error of a walk's distance. Of the
    start alone (steps, cells): cost of the cheapest walk, its exact distance, and `bound`, the least over the
    cell's walks of cost - weight |error|.
    """

    choice: np.ndarray
    low: np.ndarray
    high: np.ndarray
    least: np.ndarray
    slack: np.ndarray
    cost: np.ndarray
    distance: np.ndarray
    bound: np.ndarray


@njit(cache=True, nogil=True)
def fill(
    moves: Moves, units: np.ndarray, error: np.ndarray, weight: float, horizon: int, width: int, keep: int
) -> tuple[np.ndarray, ...]:
    """The columns of a `WalkTable`, for up to `horizon` steps and `width` cells; `keep`: longest move + 1.

    Every move but those of the start takes at least one step, so filling by steps, the start last, meets what
    it needs; costs and distances are kept for the last `keep` steps only.
    """
    first, following, steps, length, cost = moves[:5]
    states = len(first) - 1
    choice = np.empty((states, horizon + 1, width), np.uint8)
    low = np.full((states, horizon + 1), width, np.int32)
    high = np.full((states, horizon + 1), -1, np.int32)
    least = np.full((states, horizon + 1), np.inf, np.float32)
    slack = np.zeros((states, horizon + 1), np.float32)
    ring = np.empty((3, states, keep, width), np.float32)
    start = np.full((3, horizon + 1, width), np.inf, np.float32)
    for t in range(horizon + 1):
        for back in range(states):
            s = states - 1 - back
            _band(moves, units, s, t, width, low, high)
            if high[s, t] < 0:
                continue
            a, b = low[s, t], high[s, t] + 1
            into = ring[:, s, t % keep]
            picked = choice[s, t]
            into[:, a:b] = np.inf
            picked[a:b] = NONE
            for e in range(first[s], first[s + 1]):
                rest, f, pick = t - steps[e], following[e], e - first[s]
                if rest < 0 or (f < 0 and (rest > 0 or units[e] >= width)):
                    continue
                if f < 0:
                    d = units[e]
                    into[2, d] = min(into[2, d], cost[e] - np.float32(weight * error[e]))
                    if cost[e] < into[0, d]:
                        into[0, d], into[1, d], picked[d] = cost[e], length[e], pick
                    least[s, t] = min(least[s, t], cost[e])
                    slack[s, t] = max(slack[s, t], error[e])
                elif high[f, rest] >= 0:
                    least[s, t] = min(least[s, t], cost[e] + least[f, rest])
                    slack[s, t] = max(slack[s, t], error[e] + slack[f, rest])
                    far = min(high[f, rest], width - 1 - units[e])
                    _relax(
                        ring[:, f, rest % keep],
                        into,
                        picked,
                        low[f, rest],
                        far,
                        units[e],
                        cost[e],
                        np.float32(length[e]),
                        np.float32(weight * error[e]),
                        pick,
                    )
            if s == 0:
                start[:, t, a:b] = into[:, a:b]
    return choice, low, high, least, slack, start[0], start[1], start[2]


@njit(cache=True, nogil=True)
def _band(
    moves: Moves, units: np.ndarray, s: int, t: int, width: int, low: np.ndarray, high: np.ndarray
) -> None:
    """The cells that the walks from s in t steps can have."""
    first, following, steps = moves[:3]
    for e in range(first[s], first[s + 1]):
        rest, f = t - steps[e], following[e]
        if rest < 0 or (f < 0 and rest > 0):
            continue
        a = units[e] if f < 0 else low[f, rest] + units[e]
        b = units[e] if f < 0 else high[f, rest] + units[e]
        b = min(b, width - 1)
        if a <= b and (f < 0 or high[f, rest] >= 0):
            low[s, t] = min(low[s, t], a)
            high[s, t] = max(high[s, t], b)


@njit(cache=True, nogil=True)
def _relax(
    child: np.ndarray,
    into: np.ndarray,
    picked: np.ndarray,
    a: int,
    b: int,
    shift: int,
    cost: np.float32,
    length: np.float32,
    spared: np.float32,
    pick: int,
) -> None:
    """One move into cells a .. b of the state it leads to."""
    for d in range(a, b + 1):
        value = cost + child[0, d]
        if value < into[0, d + shift]:
            into[0, d + shift] = value
            into[1, d + shift] = length + child[1, d]
            picked[d + shift] = pick
        under = cost - spared + child[2, d]
        if under < into[2, d + shift]:
            into[2, d + shift] = under


@njit(cache=True, nogil=True)
def _off(value: float, wanted: float) -> float:
    """|value - wanted|; 0 where nothing is wanted."""
    return 0.0 if np.isnan(wanted) else abs(value - wanted)


@njit(cache=True, nogil=True)
def _window(
    wanted: float, tolerance: float, slack: float, quantum: float, low: int, high: int
) -> tuple[int, int]:
    """The cells whose walks may lie within the tolerance."""
    if np.isnan(wanted) or np.isinf(tolerance):
        return low, high
    far = tolerance + slack
    a, b = int(np.floor((wanted - far) / quantum)), int(np.ceil((wanted + far) / quantum))
    return max(low, a), min(high, b)


@njit(cache=True, nogil=True)
def _rows(wanted: float, tolerance: float, count: int) -> tuple[int, int]:
    if np.isnan(wanted) or np.isinf(tolerance):
        return 0, count - 1
    a, b = int(np.ceil(wanted - tolerance - 1e-6)), int(np.floor(wanted + tolerance + 1e-6))
    return max(a, 0), min(b, count - 1)


@njit(cache=True, nogil=True)
def look_up(table: WalkTable, quantum: float, targets: Targets) -> tuple[int, int, float, float, bool]:
    """(steps, cell) of the cheapest known walk within tolerances (-1 for none), its cost, a lower bound, and
    whether any walk may be within them."""
    _, low, high, _, slack, cost, distance, bound = table
    far, late, far_weight, late_weight, far_tolerance, late_tolerance = targets
    at, cell, best, under, possible = -1, -1, np.inf, np.inf, False
    first, last = _rows(late, late_tolerance, len(cost))
    for t in range(first, last + 1):
        delay = late_weight * _off(t, late)
        loose = float(slack[0, t]) + 1e-5
        a, b = _window(far, far_tolerance, loose, quantum, low[0, t], high[0, t])
        for d in range(a, b + 1):
            if np.isinf(cost[t, d]):
                continue
            rounded = _off(d * quantum, far)
            if rounded > far_tolerance + loose:
                continue
            possible = True
            lower = max(
                bound[t, d] + far_weight * rounded, cost[t, d] + far_weight * max(rounded - loose, 0.0)
            )
            under = min(under, lower + delay)
            exact = _off(distance[t, d], far)
            value = cost[t, d] + far_weight * exact + delay
            if exact <= far_tolerance + 1e-9 and value < best:
                at, cell, best = t, d, value
    return at, cell, best, under, possible


@njit(cache=True, nogil=True)
def nearest(table: WalkTable, quantum: float, targets: Targets) -> tuple[int, int]:
    """(steps, cell) of the known walk that misses least in units of the tolerances; -1 where there is none."""
    _, low, high, _, slack, cost, distance, _ = table
    far, late, _, _, far_tolerance, late_tolerance = targets
    at, cell, best = -1, -1, np.inf
    middle = 0 if np.isnan(late) else min(max(int(np.rint(late)), 0), len(cost) - 1)
    for ring in range(2 * len(cost)):
        t = middle + (ring + 1) // 2 * (1 if ring % 2 else -1)
        if t < 0 or t >= len(cost):
            continue
        delay = _off(t, late) / late_tolerance
        if delay >= best and not np.isnan(late) and abs(t - middle) > 1:
            if ring % 2 == 0:
                break
            continue
        loose = float(slack[0, t]) + 1e-5
        a, b = low[0, t], high[0, t]
        if not np.isnan(far) and np.isfinite(best):
            a, b = _window(far, (best - delay) * far_tolerance, loose, quantum, a, b)
        for d in range(a, b + 1):
            if np.isinf(cost[t, d]):
                continue
            value = _off(distance[t, d], far) / far_tolerance + delay + 1e-3 * cost[t, d]
            if value < best:
                at, cell, best = t, d, value
    return at, cell


@njit(cache=True, nogil=True)
def follow(moves: Moves, units: np.ndarray, choice: np.ndarray, t: int, d: int) -> np.ndarray:
    """The moves of the cheapest walk of a cell of the start."""
    first, following, steps = moves[:3]
    out = np.empty(2 * choice.shape[1] + 2, np.int64)
    count, s = 0, 0
    while s >= 0:
        e = first[s] + choice[s, t, d]
        out[count] = e
        count += 1
        s, t, d = following[e], t - steps[e], d - units[e]
    return out[:count]


@njit(cache=True, nogil=True)
def try_all(
    moves: Moves,
    units: np.ndarray,
    table: WalkTable,
    quantum: float,
    targets: Targets,
    best: float,
    effort: int,
) -> tuple[np.ndarray, bool]:
    """The moves of the cheapest walk within the tolerances that costs less than `best` (none: empty).

    Depth first through every cell that the bounds do not rule out; false where `effort` moves did not do.
    """
    first, following, steps, length, cost = moves[:5]
    choice, low, high, least, slack, known, _, bound = table
    far, late, far_weight, late_weight, far_tolerance, late_tolerance = targets
    depth = 2 * choice.shape[1] + 2
    move, states = np.empty(depth, np.int64), np.empty(depth, np.int64)
    rests, cells = np.empty(depth, np.int64), np.empty(depth, np.int64)
    paid, gone = np.empty(depth), np.empty(depth)
    found = np.empty(0, np.int64)
    first_row, last_row = _rows(late, late_tolerance, choice.shape[1])
    for row in range(first_row, last_row + 1):
        delay = late_weight * _off(row, late)
        loose = float(slack[0, row]) + 1e-5
        a, b = _window(far, far_tolerance, loose, quantum, low[0, row], high[0, row])
        for column in range(a, b + 1):
            rounded = _off(column * quantum, far)
            lower = max(
                bound[row, column] + far_weight * rounded,
                known[row, column] + far_weight * max(rounded - loose, 0.0),
            )
            if np.isinf(known[row, column]) or lower + delay >= best - 1e-9:
                continue
            level = 0
            states[0], rests[0], cells[0], paid[0], gone[0], move[0] = (
                0,
                row,
                column,
                delay,
                0.0,
                first[0] - 1,
            )
            while level >= 0:
                move[level] += 1
                e, s = move[level], states[level]
                if e >= first[s + 1]:
                    level -= 1
                    continue
                rest, d, f = rests[level] - steps[e], cells[level] - units[e], following[e]
                if rest < 0 or d < 0:
                    continue
                if f < 0:
                    if rest == 0 and d == 0:
                        miss = _off(gone[level] + length[e], far)
                        value = paid[level] + cost[e] + far_weight * miss
                        if miss <= far_tolerance + 1e-9 and value < best - 1e-9:
                            best, found = value, move[: level + 1].copy()
                    continue
                if d < low[f, rest] or d > high[f, rest] or choice[f, rest, d] == NONE:
                    continue
                effort -= 1
                if effort < 0:
                    return found, False
                after = gone[level] + length[e]
                miss = max(_off(after + d * quantum, far) - slack[f, rest] - 1e-5, 0.0)
                price = paid[level] + cost[e]
                if miss > far_tolerance or price + least[f, rest] + far_weight * miss >= best - 1e-9:
                    continue
                level += 1
                states[level], rests[level], cells[level] = f, rest, d
                paid[level], gone[level], move[level] = price, after, first[f] - 1
    return found, True
