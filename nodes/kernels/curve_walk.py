"""Walks through a graph along a curve on the ground: what they cost, and the cheapest one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from reperform.nodes.kernels.graph_moves import Moves

# Step of arc length in which the least remaining cost is tabled, m.
REST_STEP = 0.0025
# Walks whose bodies stand in one cell of the ground, this wide (m), facing one way within this angle (rad), at one
# frame and one stretch of the curve, are one walk: the cheapest is followed.
_CELL, _ANGLE, _STRETCH = 0.02, 0.035, 0.05
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

    Of walks that stand alike (one frame, one cell of place and direction, one stretch of the curve) the cheapest is
    followed, and of each stretch and frame the `beam` most promising: those with the least cost + rest + what the next
    half second would add if they went straight on. Where neither sets anything aside the walk is the optimum.

    Source: Boukhayma and Boyer 2015, 3DV (002 section 4, eq 8). Departure: a table over arc length in place of
    depth-first search.
    """
    found = _search(trail, rest, starts.frame.astype(np.int64), first_states(starts), beam)
    parent, move, best, cost, expanded = found
    if best < 0:
        return None
    chain = []
    while parent[best] >= 0:
        chain.append(int(move[best]))
        best = int(parent[best])
    return CurveWalk(tuple(reversed(chain)), int(-1 - parent[best]), float(cost), int(expanded))


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
def _cell(node: int, state: np.ndarray) -> int:
    """One number, never negative, for walks that stand alike: frame, direction and place."""
    turns = int(np.ceil(2 * np.pi / _ANGLE))
    turn = int(np.floor(state[0] / _ANGLE)) % turns
    x, z = int(np.floor(state[4] / _CELL)) % 4096, int(np.floor(state[5] / _CELL)) % 4096
    return ((node * turns + turn) * 4096 + x) * 4096 + z


@njit(cache=True, nogil=True)
def _place_of(key: int, keys: np.ndarray) -> int:
    """Where a cell stands in an open-addressed table, or the free place (-1) where it belongs."""
    place = (key * 0x9E3779B1 >> 7) % len(keys)
    while keys[place] >= 0 and keys[place] != key:
        place = (place + 1) % len(keys)
    return place


@njit(cache=True, nogil=True)
def _search(
    trail: Trail, rest: np.ndarray, frames: np.ndarray, states: np.ndarray, beam: int
) -> tuple[np.ndarray, np.ndarray, int, float, int]:
    size = max(1 << 16, 2 * len(frames))
    node, parent, move = np.empty(size, np.int64), np.empty(size, np.int64), np.empty(size, np.int64)
    state, after = np.empty((size, 7)), np.empty(size, np.int64)
    bins = int(trail.length / _STRETCH) + 1
    head = np.full(bins, -1, np.int64)
    used, best, least, expanded = 0, -1, np.inf, 0
    for k in range(len(frames)):
        if _rest_at(rest, frames[k], 0.0) < np.inf:
            node[used], parent[used], move[used], state[used] = frames[k], -1 - k, -1, states[k]
            after[used], head[0] = head[0], used
            used += 1
    out = np.empty(7)
    kept = np.zeros(len(trail.leaving) - 1, np.int64)
    for b in range(bins):
        keys, least_of = np.full(1 << 12, -1, np.int64), np.empty(1 << 12)
        filled = 0
        while head[b] >= 0:
            count, at = 0, head[b]
            while at >= 0:
                count, at = count + 1, after[at]
            keys, least_of = _roomy(keys, least_of, filled + count)
            here, bound = np.empty(count, np.int64), np.empty(count)
            count, at = 0, head[b]
            while at >= 0:
                key = _cell(node[at], state[at])
                place = _place_of(key, keys)
                total = state[at, 6]
                below = total + _rest_at(rest, node[at], state[at, 3])
                if below < least and (keys[place] < 0 or total < least_of[place]):
                    filled += keys[place] < 0
                    keys[place], least_of[place] = key, total
                    here[count], bound[count] = at, below + _ahead(trail, node[at], state[at])
                    count += 1
                at = after[at]
            head[b] = -1
            kept[:] = 0
            for o in np.argsort(bound[:count], kind="mergesort"):
                at = here[o]
                if kept[node[at]] == beam:
                    continue
                kept[node[at]] += 1
                # the cheapest of a cell may have come after this one
                if state[at, 6] > least_of[_place_of(_cell(node[at], state[at]), keys)]:
                    continue
                for e in range(trail.leaving[node[at]], trail.leaving[node[at] + 1]):
                    expanded += 1
                    if not follow(trail, e, state[at], out):
                        continue
                    to = trail.target[e]
                    if out[3] >= trail.length:
                        bounded = out[6]
                    else:
                        bounded = out[6] + _rest_at(rest, to, out[3])
                    if bounded >= least:
                        continue
                    if used == size:
                        size *= 2
                        node, parent, move = _grown(node), _grown(parent), _grown(move)
                        after = _grown(after)
                        larger = np.empty((size, 7))
                        larger[:used] = state
                        state = larger
                    node[used], parent[used], move[used], state[used] = to, at, e, out
                    if out[3] >= trail.length:
                        best, least = used, out[6]
                    else:
                        row = int(out[3] / _STRETCH)
                        after[used], head[row] = head[row], used
                    used += 1
    return parent[:used], move[:used], best, least, expanded


@njit(cache=True, nogil=True)
def _grown(array: np.ndarray) -> np.ndarray:
    larger = np.empty(2 * len(array), array.dtype)
    larger[: len(array)] = array
    return larger


@njit(cache=True, nogil=True)
def _roomy(keys: np.ndarray, values: np.ndarray, wanted: int) -> tuple[np.ndarray, np.ndarray]:
    """The table, made larger until at most half of it is taken once `wanted` cells are in it."""
    size = len(keys)
    while size < 2 * wanted:
        size *= 2
    if size == len(keys):
        return keys, values
    larger, moved = np.full(size, -1, np.int64), np.empty(size)
    for k in range(len(keys)):
        if keys[k] >= 0:
            place = _place_of(keys[k], larger)
            larger[place], moved[place] = keys[k], values[k]
    return larger, moved
