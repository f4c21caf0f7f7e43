"""What walks to the end cost at least, by place, steps and distance: the table that guides a search."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from reperform.nodes.kernels.walk_moves import Moves

# Least costs are kept as whole numbers of this unit, rounded down; dearer ones than can be kept count as the dearest.
UNIT = 1e-4
NONE = np.uint16(65535)
_DEAREST = 65534
# What float32 sums of costs may be off, in units.
_ROUNDING = 0.1
# What float32 sums of parts of a cell may be off.
_ROUNDED = np.float32(1e-4)
# Fine cells per kept cell: bounds are worked out finely and kept coarsely.
FINE = 4
# A shift this near to a whole number of fine cells is one.
_WHOLE = 1e-6
# Fine cells before distance 0, so that a shift of less than a cell cannot lead out of the table.
_BEFORE = 1


class WalkTable(NamedTuple):
    """Lower bounds of the cost of every walk from a state to the end.

    least (states, steps, cells): of the walks of so many steps whose distance lies in the cell, in units of 1e-4; NONE
    where no walk does; low, high (states, steps): the first and the last cell with walks. Cell k of state s holds
    distances from (k - 1 / FINE) cell - phase[s] on; cell, phase in m.
    """

    least: np.ndarray
    low: np.ndarray
    high: np.ndarray
    phase: np.ndarray
    cell: float


def fill_table(moves: Moves, horizon: int, reach: float, cell: float, weight: float) -> WalkTable:
    """The table for up to `horizon` steps and `reach` m.

    In every fine cell [x0, x0 + q] all walks of a state in t steps, distance x and cost c, are summed up by

        c >= max(base, left - weight (x - x0), right - weight (x0 + q - x)),   x0 + before <= x <= x0 + q - behind

    which a move of any length carries over to the two cells that it leads to. Where walks lie one to a cell, or closer
    together than their costs differ, nothing is lost. Moves along a take shift by whole cells. weight, 1/m, only decides
    what is summed up closely: any gives lower bounds.
    """
    fine = cell / FINE
    first = np.minimum(moves.first[:-1], len(moves.start) - 1)
    phase = (moves.start[first] / fine) % 1.0
    arriving = np.where(moves.following < 0, 0.0, (moves.end / fine) % 1.0)
    leaving = np.repeat(phase, np.diff(moves.first))
    shift = moves.length / fine + leaving - arriving
    shift = np.where(np.abs(shift - np.rint(shift)) < _WHOLE, np.rint(shift), shift)
    whole = np.floor(shift)
    kept = int(np.ceil((reach / fine + 2 + _BEFORE) / FINE))
    # how long the cells of a state are needed: until the longest move into it is over
    keep = np.ones(len(moves.first) - 1, np.int64)
    inner = moves.following >= 0
    np.maximum.at(keep, moves.following[inner], moves.steps[inner] + 1)
    least, low, high = _fill(
        moves, whole.astype(np.int64), shift - whole, float(weight * fine), horizon, kept, keep
    )
    return WalkTable(least, low, high, phase * fine, cell)


@njit(cache=True, nogil=True)
def _fill(
    moves: Moves,
    shift: np.ndarray,
    part: np.ndarray,
    slope: float,
    horizon: int,
    kept: int,
    keep: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Every move but those of the start takes at least one step: by steps, the start last, all is known in time."""
    first, following, steps, _, cost = moves[:5]
    states, width = len(first) - 1, kept * FINE
    least = np.full((states, horizon + 1, kept), NONE, np.uint16)
    low = np.full((states, horizon + 1), width, np.int32)
    high = np.full((states, horizon + 1), -1, np.int32)
    # base, left, right, before and behind of the last steps of each state
    row = np.concatenate((np.zeros(1, np.int64), np.cumsum(keep)))
    ring = np.empty((5, row[-1], width), np.float32)
    for t in range(horizon + 1):
        for back in range(states):
            s = states - 1 - back
            _band(moves, shift, part, s, t, width, low, high)
            if high[s, t] < 0:
                continue
            into = ring[:, row[s] + t % keep[s]]
            into[:, low[s, t] : high[s, t] + 1] = np.inf
            for e in range(first[s], first[s + 1]):
                rest, f = t - steps[e], following[e]
                if rest < 0 or (f < 0 and rest > 0):
                    continue
                over, short = np.float32(part[e]), np.float32(1.0 - part[e])
                steep = np.float32(slope)
                if f < 0:
                    d = shift[e] + _BEFORE
                    if d < width:
                        into[0, d] = min(into[0, d], cost[e])
                        into[1, d] = min(into[1, d], cost[e] + steep * over)
                        into[2, d] = min(into[2, d], cost[e] + steep * short)
                        into[3, d], into[4, d] = min(into[3, d], over), min(into[4, d], short)
                elif high[f, rest] >= 0:
                    a, b = low[f, rest], min(high[f, rest] + 1, width - 1 - shift[e])
                    if a >= b:
                        continue
                    r = row[f] + rest % keep[f]
                    base, left, right = ring[0, r][a:b], ring[1, r][a:b], ring[2, r][a:b]
                    before, behind = ring[3, r][a:b], ring[4, r][a:b]
                    c, d = a + shift[e], b + shift[e] + 1
                    new_base, new_left, new_right = into[0][c:d], into[1][c:d], into[2][c:d]
                    new_before, new_behind = into[3][c:d], into[4][c:d]
                    if part[e] == 0.0:
                        zero = np.float32(0.0)
                        _add(base, cost[e], new_base)
                        _add(left, cost[e], new_left)
                        _add(right, cost[e], new_right)
                        _add(before, zero, new_before)
                        _add(behind, zero, new_behind)
                    else:
                        # the part of a cell that stays short of the next one, then the part that reaches it
                        _carry(
                            base, left, right, before, behind, cost[e], steep, over, short,
                            new_base, new_left, new_right, new_before, new_behind,
                        )  # fmt: skip
                        _carry(
                            base, right, left, behind, before, cost[e], steep, short, over,
                            new_base[1:], new_right[1:], new_left[1:], new_behind[1:], new_before[1:],
                        )  # fmt: skip
            for k in range(low[s, t] // FINE, high[s, t] // FINE + 1):
                a, b = max(k * FINE, low[s, t]), min(k * FINE + FINE, high[s, t] + 1)
                under = into[0, a:b].min()
                if under < np.inf:
                    least[s, t, k] = int(min(max(under / UNIT - _ROUNDING, 0.0), _DEAREST))
    return least, low // FINE, np.where(high < 0, -1, high // FINE)


@njit(cache=True, nogil=True)
def _band(
    moves: Moves,
    shift: np.ndarray,
    part: np.ndarray,
    s: int,
    t: int,
    width: int,
    low: np.ndarray,
    high: np.ndarray,
) -> None:
    """The fine cells that the walks from s in t steps can have."""
    first, following, steps = moves[:3]
    for e in range(first[s], first[s + 1]):
        rest, f = t - steps[e], following[e]
        if rest < 0 or (f < 0 and rest > 0) or (f >= 0 and high[f, rest] < 0):
            continue
        a = _BEFORE if f < 0 else low[f, rest]
        b = _BEFORE if f < 0 else high[f, rest] + (part[e] > 0.0)
        a, b = max(a + shift[e], _BEFORE), min(b + shift[e], width - 1)
        if a <= b:
            low[s, t], high[s, t] = min(low[s, t], a), max(high[s, t], b)


@njit(cache=True, nogil=True)
def _add(values: np.ndarray, cost: np.float32, out: np.ndarray) -> None:
    for i in range(len(values)):
        v = values[i] + cost
        out[i] = v if v < out[i] else out[i]


@njit(cache=True, nogil=True)
def _carry(
    base: np.ndarray,
    near: np.ndarray,
    far: np.ndarray,
    near_gap: np.ndarray,
    far_gap: np.ndarray,
    cost: np.float32,
    steep: np.float32,
    out: np.float32,
    cut: np.float32,
    new_base: np.ndarray,
    new_near: np.ndarray,
    new_far: np.ndarray,
    new_near_gap: np.ndarray,
    new_far_gap: np.ndarray,
) -> None:
    """One side of every cell into the cell it falls in: `near` is the bound at the edge that lies in that cell.

    The edge of that cell lies `out` further out than the old one, the other end of the side `cut` from the old one.
    """
    inf, zero, sure = np.float32(np.inf), np.float32(0.0), cut + _ROUNDED
    rise, fall = cost + steep * out, cost - steep * cut
    under = cost - steep * out
    for i in range(len(base)):
        v, a = base[i] + cost, near[i] + fall
        v = a if a > v else v
        v = v if near_gap[i] <= sure else inf
        new_base[i] = v if v < new_base[i] else new_base[i]
    for i in range(len(base)):
        v = near[i] + rise
        v = v if near_gap[i] <= sure else inf
        new_near[i] = v if v < new_near[i] else new_near[i]
    for i in range(len(base)):
        v, a, b = base[i] + cost, near[i] + fall, far[i] + under
        v = a if a > v else v
        v = b if b > v else v
        v = v if near_gap[i] <= sure else inf
        new_far[i] = v if v < new_far[i] else new_far[i]
    for i in range(len(base)):
        v = near_gap[i] + out
        v = v if near_gap[i] <= sure else inf
        new_near_gap[i] = v if v < new_near_gap[i] else new_near_gap[i]
    for i in range(len(base)):
        v = far_gap[i] - out
        v = v if v > zero else zero
        v = v if near_gap[i] <= sure else inf
        new_far_gap[i] = v if v < new_far_gap[i] else new_far_gap[i]


@njit(cache=True, nogil=True)
def least_cost(
    table: WalkTable, s: int, t: int, distance: float, tolerance: float, weight: float, limit: float
) -> float:
    """Lower bound of cost + weight |x - distance| of the walks from s in t steps with |x - distance| <= tolerance.

    `limit` where it is not under that, or there is none.
    """
    least, low, high, phase, cell = table
    y = distance + phase[s] + cell / FINE * _BEFORE
    # a micrometre for what sums of distances are off
    a, b = low[s, t], high[s, t]
    if np.isfinite(tolerance):
        a = max(a, int(np.floor(max((y - tolerance - 1e-6) / cell, -1.0))))
        b = min(b, int(np.floor(min((y + tolerance + 1e-6) / cell, 1e9))))
    if a > b:
        return limit
    middle = min(max(int(np.floor(min(max(y / cell, -1.0), 1e9))), a), b)
    for k in range(middle, b + 1):
        off = weight * max(k * cell - y, y - (k + 1) * cell, 0.0)
        if k > middle and off >= limit:
            break
        if least[s, t, k] != NONE:
            limit = min(limit, least[s, t, k] * UNIT + off)
    for back in range(middle - a):
        k = middle - 1 - back
        off = weight * max(y - (k + 1) * cell, 0.0)
        if off >= limit:
            break
        if least[s, t, k] != NONE:
            limit = min(limit, least[s, t, k] * UNIT + off)
    return limit


@njit(cache=True, nogil=True)
def least_by_steps(moves: Moves, horizon: int) -> np.ndarray:
    """Least cost of the walks from every state to the end in so many steps, (states, horizon + 1); inf: none."""
    first, following, steps, _, cost = moves[:5]
    states = len(first) - 1
    least = np.full((states, horizon + 1), np.inf)
    for t in range(horizon + 1):
        for back in range(states):
            s = states - 1 - back
            for e in range(first[s], first[s + 1]):
                rest, f = t - steps[e], following[e]
                if rest < 0 or (f < 0 and rest > 0):
                    continue
                least[s, t] = min(least[s, t], cost[e] + (0.0 if f < 0 else least[f, rest]))
    return least
