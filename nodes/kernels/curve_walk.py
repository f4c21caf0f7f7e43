"""Walks through a graph along a curve on the ground: what they cost, and the cheapest one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from reperform.nodes.kernels.graph_moves import Moves

# Step of arc length in which the least remaining cost is tabled, m.
REST_STEP = 0.0025
# Walks are tabled by stretches of the curve, m, and the frame they have come to.
_STRETCH = 0.05
# Two of one place in the table that are this near each other on the ground (m), in direction (rad) and in arc length
# (m) are one walk: the more promising is followed.
_CELL, _ANGLE, _ARC = 0.05, 0.1, 0.01
# Walks kept of one stretch and frame: as many as there are ways for a standing body to face, and some.
_KEPT = 64
# Where a stretch is crowded, so many of one frame are followed, so that they differ.
_OF_ONE_FRAME = 4
# To tell which walks are promising, each is thought on straight for this arc length (m), as if in so many frames.
_PREVIEW, _AHEAD = 0.6, 12


class Curve(NamedTuple):
    """A curve on the ground sampled at even steps of arc length, and what may be played where."""

    points: np.ndarray  # (M, 2) x, z, m; goes on straight beyond the end
    step: float  # m
    length: float  # m
    allowed: np.ndarray  # (takes, M) bool


class Starts(NamedTuple):
    """Where walks may set out: frames (S,), and placements of their takes that put the body on the curve's start."""

    frame: np.ndarray
    yaw: np.ndarray
    offset: np.ndarray
    middle: np.ndarray  # (S, 2) where the body then is


class CurveWalk(NamedTuple):
    """Moves in order, the start chosen, the cost, and how many walks were followed by one move."""

    chain: tuple[int, ...]
    start: int
    cost: float
    expanded: int


class Trail(NamedTuple):
    """What a search needs of the moves and the curve, as plain arrays."""

    leaving: np.ndarray
    target: np.ndarray
    cost: np.ndarray
    first: np.ndarray
    take: np.ndarray
    weight: np.ndarray
    yaw: np.ndarray
    offset: np.ndarray
    middle: np.ndarray
    # (N, 2) unit vector of the body's way from each frame on, in its take; 0 where it stands
    way: np.ndarray
    points: np.ndarray
    step: float
    length: float
    allowed: np.ndarray
    distance_weight: float


def trail(moves: Moves, curve: Curve, distance_weight: float) -> Trail:
    """Moves and curve made ready; distance_weight: cost of one frame one metre off the curve."""
    return Trail(
        moves.leaving, moves.target, moves.cost, moves.first, moves.take, moves.weight, moves.yaw, moves.offset,
        moves.middle, _ways(moves), *curve, distance_weight,
    )  # fmt: skip


def _ways(moves: Moves) -> np.ndarray:
    """Where the body goes from each captured frame on, seen over the preview's frames, (N, 2)."""
    count = len(moves.leaving) - 1
    last, at = np.arange(count), np.full((count, 2), np.nan)
    captured = np.flatnonzero(moves.weight[moves.first[1:] - 1] == 0.0)
    for row, frame in ((0, moves.source), (1, moves.target)):
        at[frame[captured]] = moves.middle[moves.first[captured] + row][:, [0, 2]]
    onward = np.arange(count)
    onward[moves.source[captured]] = moves.target[captured]
    for _ in range(_AHEAD):
        last = onward[last]
    way = np.nan_to_num(at[last] - at[np.arange(count)])
    # towards a take's end there is less to see: go by where it came from
    short = last - np.arange(count) < _AHEAD // 2
    for frame in np.flatnonzero(short)[1:]:
        if onward[frame - 1] == frame:
            way[frame] = way[frame - 1]
    size = np.linalg.norm(way, axis=1, keepdims=True)
    return np.where(size > 0.05, way / np.maximum(size, 1e-9), 0.0)


def remaining_cost(moves: Moves, curve: Curve) -> np.ndarray:
    """A lower bound (bins, N) of the moves' cost from each frame at each stretch of the curve to its end.

    bins of REST_STEP of arc length; inf where the end cannot be reached with what is allowed. Distances from the
    curve are left out and arc lengths rounded up, so that no walk costs less.
    """
    step = np.linalg.norm(np.diff(moves.middle[:, [0, 2]], axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(step)])
    arc = along[moves.first[1:] - 1] - along[moves.first[:-1]]
    arrives = moves.take[moves.first[1:] - 1, 1]
    return _remaining(
        moves.leaving, moves.target, moves.cost, arc, arrives, curve.step, curve.length, curve.allowed
    )


@njit(cache=True, nogil=True)
def _remaining(
    leaving: np.ndarray,
    target: np.ndarray,
    cost: np.ndarray,
    arc: np.ndarray,
    arrives: np.ndarray,
    step: float,
    length: float,
    allowed: np.ndarray,
) -> np.ndarray:
    count, bins = len(leaving) - 1, int(length / REST_STEP) + 1
    table = np.full((bins + 1, count), np.inf)
    table[bins] = 0.0
    for b in range(bins - 1, -1, -1):
        for i in range(count):
            for e in range(leaving[i], leaving[i + 1]):
                low, high = b * REST_STEP + arc[e], (b + 1) * REST_STEP + arc[e]
                then = min(int(high / REST_STEP + 1e-9), bins)
                near = allowed[arrives[e], min(int(low / step), allowed.shape[1] - 1)]
                near |= allowed[arrives[e], min(int(high / step) + 1, allowed.shape[1] - 1)]
                if near and cost[e] + table[then, target[e]] < table[b, i]:
                    table[b, i] = cost[e] + table[then, target[e]]
    return table


@njit(cache=True, nogil=True)
def follow(trail: Trail, e: int, state: np.ndarray, out: np.ndarray) -> bool:
    """Take move e from a state (yaw, offset x, z, arc length, body x, z, cost) to `out`; False where not allowed.

    Each frame adds distance_weight times its distance from the curve's point at the arc length walked so far.
    """
    yaw, ox, oz, s, px, pz, cost = state
    c, n = np.cos(yaw), np.sin(yaw)
    cost += trail.cost[e]
    last = trail.points.shape[0] - 1
    for p in range(trail.first[e] + 1, trail.first[e + 1]):
        mx, mz = trail.middle[p, 0], trail.middle[p, 2]
        x, z = c * mx + n * mz + ox, -n * mx + c * mz + oz
        s += np.sqrt((x - px) ** 2 + (z - pz) ** 2)
        px, pz = x, z
        place = min(s / trail.step, last - 1.0)
        k = int(place)
        side = 1 if trail.weight[p] > 0.5 else 0
        if s < trail.length and not trail.allowed[trail.take[p, side], k]:
            return False
        part = place - k
        gx = (1 - part) * trail.points[k, 0] + part * trail.points[k + 1, 0] - x
        gz = (1 - part) * trail.points[k, 1] + part * trail.points[k + 1, 1] - z
        cost += trail.distance_weight * np.sqrt(gx * gx + gz * gz)
    p = trail.first[e + 1] - 1
    out[0] = yaw + trail.yaw[p, 1]
    out[1] = c * trail.offset[p, 1, 0] + n * trail.offset[p, 1, 1] + ox
    out[2] = -n * trail.offset[p, 1, 0] + c * trail.offset[p, 1, 1] + oz
    out[3], out[4], out[5], out[6] = s, px, pz, cost
    return True


def first_states(starts: Starts) -> np.ndarray:
    """States (S, 7) as `follow` takes them."""
    none = np.zeros(len(starts.frame))
    return np.column_stack([starts.yaw, starts.offset, none, starts.middle, none])


def curve_walk(trail: Trail, rest: np.ndarray, starts: Starts, beam: int) -> CurveWalk | None:
    """The cheapest walk from a start to the curve's end, by dynamic programming over arc length; None: there is none.

        cost = sum of the moves' costs + distance_weight sum over frames |body - curve(arc length walked)|

    Of walks that stand alike (one frame, nearly one place, direction and arc length) the more promising is followed,
    and of each stretch of the curve the `beam` most promising, at most four of one frame where there are more: those
    with the least cost + rest + what the next half second would add if they went straight on. Where nothing is set
    aside the walk is the optimum.

    Source: Boukhayma and Boyer 2015, 3DV (002 section 4, eq 8). Departure: a table over arc length in place of
    depth-first search.
    """
    along = np.concatenate(
        [[0.0], np.cumsum(np.linalg.norm(np.diff(trail.middle[:, [0, 2]], axis=0), axis=1))]
    )
    farthest = float((along[trail.first[1:] - 1] - along[trail.first[:-1]]).max())
    # a move ends at most so many stretches on: the table's rows are used in turn
    table = _table(int(farthest / _STRETCH) + 3, len(trail.leaving) - 1, min(_KEPT, beam))
    found = _search(trail, rest, starts.frame.astype(np.int64), first_states(starts), beam, table)
    parent, move, best, cost, expanded = found
    if best < 0:
        return None
    chain = []
    while parent[best] >= 0:
        chain.append(int(move[best]))
        best = int(parent[best])
    return CurveWalk(tuple(reversed(chain)), int(-1 - parent[best]), float(cost), int(expanded))


class _Table(NamedTuple):
    """Walks by row (a stretch of the curve), frame and place, the first filled[row, frame] of them."""

    state: np.ndarray  # (rows, N, places, 7)
    value: np.ndarray  # (rows, N, places) the less, the more promising
    step: np.ndarray  # (rows, N, places) how it came there, a number of the log
    waits: np.ndarray  # (rows, N, places) bool, to be followed
    filled: np.ndarray  # (rows, N)


def _table(rows: int, frames: int, places: int) -> _Table:
    size = (rows, frames, places)
    return _Table(
        np.empty((*size, 7)), np.empty(size), np.empty(size, np.int64), np.zeros(size, bool),
        np.zeros((rows, frames), np.int64),
    )  # fmt: skip


@njit(cache=True, nogil=True)
def _rest_at(rest: np.ndarray, node: int, s: float) -> float:
    return rest[min(int(s / REST_STEP), rest.shape[0] - 1), node]


@njit(cache=True, nogil=True)
def _ahead(trail: Trail, node: int, state: np.ndarray) -> float:
    """What the next frames would add if the body went straight on."""
    c, n = np.cos(state[0]), np.sin(state[0])
    wx, wz = trail.way[node, 0], trail.way[node, 1]
    if wx == 0.0 and wz == 0.0:
        return 0.0
    x, z = state[4] + _PREVIEW * (c * wx + n * wz), state[5] + _PREVIEW * (-n * wx + c * wz)
    k = min(int((state[3] + _PREVIEW) / trail.step), trail.points.shape[0] - 1)
    gap = np.sqrt((trail.points[k, 0] - x) ** 2 + (trail.points[k, 1] - z) ** 2)
    return trail.distance_weight * _AHEAD * 0.5 * gap


@njit(cache=True, nogil=True)
def _alike(one: np.ndarray, other: np.ndarray) -> bool:
    return (
        abs(one[3] - other[3]) < _ARC
        and abs(one[4] - other[4]) < _CELL
        and abs(one[5] - other[5]) < _CELL
        and np.cos(one[0] - other[0]) > np.cos(_ANGLE)
    )


@njit(cache=True, nogil=True)
def _place(table: _Table, row: int, node: int, state: np.ndarray, value: float) -> int:
    """Where a walk goes in the table, those like it gone from there; -1: it is not promising enough."""
    count = table.filled[row, node]
    alike, worst = -1, 0
    for k in range(count):
        if table.value[row, node, k] < np.inf and _alike(table.state[row, node, k], state):
            if table.value[row, node, k] <= value:
                return -1
            table.value[row, node, k], table.waits[row, node, k] = np.inf, False
            alike = k
        if table.value[row, node, k] > table.value[row, node, worst]:
            worst = k
    if alike >= 0:
        return alike
    if count < table.value.shape[2]:
        table.filled[row, node] += 1
        return count
    return worst if value < table.value[row, node, worst] else -1


@njit(cache=True, nogil=True)
def _chosen(table: _Table, row: int, beam: int) -> tuple[np.ndarray, np.ndarray]:
    """Frames and places of those to be followed now, the most promising first; none waits any more."""
    total = np.count_nonzero(table.waits[row])
    node, place, value = np.empty(total, np.int64), np.empty(total, np.int64), np.empty(total)
    count = 0
    for i in range(table.filled.shape[1]):
        for k in range(table.filled[row, i]):
            if table.waits[row, i, k]:
                node[count], place[count], value[count] = i, k, table.value[row, i, k]
                count += 1
                table.waits[row, i, k] = False
    order = np.argsort(value, kind="mergesort")
    if total > beam:
        of_one, few = np.zeros(table.filled.shape[1], np.int64), 0
        for o in order:
            if few < beam and of_one[node[o]] < _OF_ONE_FRAME:
                of_one[node[o]] += 1
                order[few] = o
                few += 1
        order = order[:few]
    return node[order], place[order]


@njit(cache=True, nogil=True)
def _search(
    trail: Trail, rest: np.ndarray, frames: np.ndarray, states: np.ndarray, beam: int, table: _Table
) -> tuple[np.ndarray, np.ndarray, int, float, int]:
    rows = table.filled.shape[0]
    parent, move = np.empty(1 << 16, np.int64), np.empty(1 << 16, np.int64)
    used, best, least, expanded = 0, -1, np.inf, 0
    out = np.empty(7)
    for b in range(int(trail.length / _STRETCH) + 1):
        row, setting_out = b % rows, b == 0
        while True:
            if setting_out:
                # all of them are followed: they may differ in direction only
                node, place = frames, np.arange(len(frames))
            else:
                node, place = _chosen(table, row, beam)
            if len(node) == 0:
                break
            for i, k in zip(node, place):  # noqa: B905
                if setting_out:
                    here, step = states[k], used
                    parent, move = _roomy(parent, used), _roomy(move, used)
                    parent[used], move[used] = -1 - k, -1
                    used += 1
                elif table.waits[row, i, k] or table.value[row, i, k] == np.inf:
                    # its place was taken since, or it is like a more promising one
                    continue
                else:
                    # a copy: one that ends in the same stretch may take this place
                    here, step = table.state[row, i, k].copy(), table.step[row, i, k]
                if here[6] + _rest_at(rest, i, here[3]) >= least:
                    continue
                for e in range(trail.leaving[i], trail.leaving[i + 1]):
                    expanded += 1
                    if not follow(trail, e, here, out):
                        continue
                    to, arrived = trail.target[e], out[3] >= trail.length
                    bound = out[6] if arrived else out[6] + _rest_at(rest, to, out[3])
                    if bound >= least:
                        continue
                    then, free = int(out[3] / _STRETCH) % rows, 0
                    if not arrived:
                        value = bound + _ahead(trail, to, out)
                        free = _place(table, then, to, out, value)
                        if free < 0:
                            continue
                        table.state[then, to, free], table.value[then, to, free] = out, value
                        table.step[then, to, free], table.waits[then, to, free] = used, True
                    else:
                        best, least = used, out[6]
                    parent, move = _roomy(parent, used), _roomy(move, used)
                    parent[used], move[used] = step, e
                    used += 1
            setting_out = False
        table.filled[row] = 0
    return parent[:used], move[:used], best, least, expanded


@njit(cache=True, nogil=True)
def _roomy(array: np.ndarray, used: int) -> np.ndarray:
    """The array, made larger where it is full."""
    if used < len(array):
        return array
    larger = np.empty(2 * len(array), array.dtype)
    larger[: len(array)] = array
    return larger
