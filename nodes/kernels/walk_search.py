"""The cheapest walk near a distance and a time, by labels led by what remains at least."""

from __future__ import annotations

import numpy as np
from numba import njit

from reperform.nodes.kernels.walk_moves import Moves, Targets
from reperform.nodes.kernels.walk_table import WalkTable, least_cost

# Walks so far to one place in one time whose distances (m) differ by no more than sums in another order do are one.
_ALIKE = 1e-9
# Limits that rise by more than so many first steps are given up for none.
_RISES = 1024.0
# Labels kept at one step where the search for the cheapest takes too many: few, then more where few find nothing.
_WIDTHS = (6, 24)


@njit(cache=True, nogil=True)
def cheapest_walk(
    moves: Moves, table: WalkTable, targets: Targets, step: float, effort: int
) -> tuple[np.ndarray, float, float, bool]:
    """The moves of the cheapest walk within the tolerances (none: empty), its cost, a lower bound, whether it is proved.

    Everything under a limit is searched; the limit rises in doubling steps, the first `step` above the table's bound,
    until a walk is found, which then is the cheapest. After `effort` labels the bound stays where it is, and the first
    walk that few labels per step find is taken. Proved: the walk is one, or there is none.
    """
    distance, steps, weight, late_weight, tolerance, late_tolerance = targets
    if np.isnan(distance):
        distance, weight, tolerance = 0.0, 0.0, np.inf
    first, last = 0, table.low.shape[1] - 1
    if not np.isnan(steps):
        first = max(first, int(np.ceil(max(steps - late_tolerance - 1e-6, 0.0))))
        last = min(last, int(np.floor(min(steps + late_tolerance + 1e-6, float(last)))))
    else:
        steps, late_weight = 0.0, 0.0
    found = np.empty(0, np.int64)
    if last < first:
        return found, np.inf, np.inf, True
    delay = late_weight * np.abs(np.arange(first, last + 1) - steps)
    under = np.array(
        [least_cost(table, 0, first + k, distance, tolerance, weight, np.inf) for k in range(len(delay))]
    )
    rows = np.argsort(under + delay, kind="mergesort")
    bound, best, rise = under[rows[0]] + delay[rows[0]], np.inf, step
    while bound < np.inf:
        limit = bound + rise if rise <= _RISES * step else np.inf
        for k in rows:
            if under[k] + delay[k] >= min(limit, best):
                break
            walk, cost, used = search_walk(
                moves, table, first + k, distance, tolerance, weight, min(limit, best) - delay[k], effort + 1, effort
            )  # fmt: skip
            effort -= used
            if len(walk) > 0:
                found, best = walk, cost + delay[k]
            if effort < 0:
                break
        if effort < 0:
            break
        if len(found) > 0:
            return found, best, best, True
        bound, rise = limit, 2.0 * rise
    if bound == np.inf:
        return found, best, bound, True
    for width in _WIDTHS:
        for k in rows:
            if len(found) > 0 or under[k] == np.inf:
                break
            found, cost, _ = search_walk(
                moves, table, first + k, distance, tolerance, weight, np.inf, 4 * width * (last + 1), width
            )
            best = cost + delay[k]
    return found, best, min(bound, best), len(found) > 0


@njit(cache=True, nogil=True)
def search_walk(
    moves: Moves,
    table: WalkTable,
    length: int,
    distance: float,
    tolerance: float,
    weight: float,
    limit: float,
    labels: int,
    width: int,
) -> tuple[np.ndarray, float, int]:
    """The walk of `length` steps with |x - distance| <= tolerance of least cost + weight |x - distance| < limit.

    Labels (place; steps, distance and cost so far) are laid step by step. One is dropped where another like it costs no
    more, or where its cost and the least that remains reach the best walk's; of more than `width` at one step the best
    stay.

    Returns the moves (none: empty), the cost (or limit), and the labels laid: where these are `labels`, the search broke
    off.
    """
    first, following, steps, along, cost = moves[:5]
    state, parent = np.empty(labels, np.int32), np.empty(labels, np.int32)
    move, behind = np.empty(labels, np.int32), np.empty(labels, np.int32)
    gone, paid, whole = np.empty(labels), np.empty(labels), np.empty(labels)
    latest = np.full(length + 1, -1, np.int32)
    state[0], parent[0], gone[0], paid[0], whole[0] = 0, -1, 0.0, 0.0, 0.0
    count, last, final, best = 1, -1, -1, limit
    chosen = np.zeros(1, np.int64)
    for t in range(-1, length + 1):
        # the start is left before all else, since some of its moves take no step
        if t >= 0:
            if latest[t] < 0:
                continue
            chosen = _layer(latest[t], behind, state, gone, paid)
            if len(chosen) > width:
                chosen = chosen[np.argsort(whole[chosen], kind="mergesort")[:width]]
        for i in chosen:
            s = state[i]
            if whole[i] >= best:
                continue
            for e in range(first[s], first[s + 1]):
                f, now = following[e], max(t, 0) + steps[e]
                after, price = gone[i] + along[e], paid[i] + cost[e]
                if now > length:
                    continue
                if f < 0:
                    off = abs(after - distance)
                    if now == length and off <= tolerance + 1e-9 and price + weight * off < best:
                        best, last, final = price + weight * off, int(i), e
                    continue
                room = best - price
                rest = least_cost(table, f, length - now, distance - after, tolerance, weight, room)
                if rest >= room:
                    continue
                if count == labels:
                    return _traced(last, final, parent, move), best, count
                state[count], parent[count], move[count] = f, i, e
                gone[count], paid[count], whole[count] = after, price, price + rest
                behind[count], latest[now] = latest[now], count
                count += 1
    return _traced(last, final, parent, move), best, count


@njit(cache=True, nogil=True)
def _layer(i: int, behind: np.ndarray, state: np.ndarray, gone: np.ndarray, paid: np.ndarray) -> np.ndarray:
    """The labels of one step, from i on, without those that cost no less than one like them."""
    count, j = 0, i
    while j >= 0:
        count, j = count + 1, int(behind[j])
    found = np.empty(count, np.int64)
    for k in range(count):
        found[k], i = i, int(behind[i])
    if count == 1:
        return found
    found = found[np.argsort(gone[found], kind="mergesort")]
    found = found[np.argsort(state[found], kind="mergesort")]
    kept = 1
    for k in range(1, count):
        one, other = found[kept - 1], found[k]
        if state[one] == state[other] and gone[other] - gone[one] <= _ALIKE:
            if paid[other] < paid[one]:
                found[kept - 1] = other
        else:
            found[kept] = other
            kept += 1
    return found[:kept]


@njit(cache=True, nogil=True)
def _traced(last: int, final: int, parent: np.ndarray, move: np.ndarray) -> np.ndarray:
    """The moves of the walk that ends with `final` after label `last`."""
    count, i = 0, last
    while i >= 0:
        count, i = count + 1, int(parent[i])
    out, i = np.empty(count, np.int64), last
    for k in range(count):
        if k == 0:
            out[count - 1] = final
        else:
            out[count - 1 - k], i = move[i], int(parent[i])
    return out
