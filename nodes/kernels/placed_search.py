"""Walks between key frames that also end near a place and a heading."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.ground_plane import Placement, rotate_ground
from reperform.nodes.kernels.path_frames import Passage
from reperform.nodes.kernels.walk_moves import Moves, Targets, Walk
from reperform.nodes.kernels.walk_table import least_by_steps

# Walks that agree in place (m), turn (rad) and distance (m) to within these are one: the cheapest of them stays.
_ALIKE = np.array([0.02, 0.02, 0.02, 0.02])


class Goal(NamedTuple):
    """Where the last frame's centroid should be (x, z), m, nan where free, and its placement's turn, rad; weights."""

    place: np.ndarray
    yaw: float
    place_weight: float
    yaw_weight: float
    # centroid of the last key frame in its take
    end: np.ndarray

    def miss(self, yaw: np.ndarray, offset: np.ndarray) -> np.ndarray:
        """Cost of ending with these placements (n,), (n, 2)."""
        c, s = np.cos(yaw), np.sin(yaw)
        x, z = c * self.end[0] + s * self.end[1], -s * self.end[0] + c * self.end[1]
        away = np.nan_to_num(np.hypot(x + offset[:, 0] - self.place[0], z + offset[:, 1] - self.place[1]))
        turn = np.nan_to_num(np.abs((yaw - self.yaw + np.pi) % (2 * np.pi) - np.pi))
        return np.asarray(self.place_weight * away + self.yaw_weight * turn)


class _Layer(NamedTuple):
    """Walks so far to one state in one number of steps: cost, distance, turn, shift, and where each came from."""

    cost: np.ndarray
    distance: np.ndarray
    yaw: np.ndarray
    offset: np.ndarray
    move: np.ndarray
    parent: np.ndarray


def best_placed(
    moves: Moves, passages: Sequence[Passage], targets: Targets, goal: Goal, horizon: int, width: int
) -> Walk | None:
    """The cheapest walk found within the tolerances, its end's miss included; None where none is found.

        cost = sum of transition costs + weighted misses of distance, time, place and heading

    Layer by layer over steps; of each state and number of steps the `width` cheapest walks stay, of those nearly
    alike in place, turn and distance one. `bound` is the least cost to the end in time, whatever the place.
    """
    least = least_by_steps(moves, horizon)
    rows = np.arange(horizon + 1)
    late = np.nan_to_num(np.abs(rows - targets.steps))
    rows = rows[(late <= targets.steps_tolerance + 1e-6) & np.isfinite(least[0])]
    if len(rows) == 0:
        return None
    layers: dict[tuple[int, int], list[_Layer]] = {(0, 0): [_start()]}
    kept: dict[tuple[int, int], _Layer] = {}
    ends: list[tuple[float, tuple[int, int], int, int]] = []
    for t in range(int(rows[-1]) + 1):
        for state in range(len(moves.first) - 1):
            if (state, t) not in layers:
                continue
            layer = kept[state, t] = _thinned(layers.pop((state, t)), width)
            for e in range(int(moves.first[state]), int(moves.first[state + 1])):
                after, then = int(moves.following[e]), t + int(moves.steps[e])
                moved = _moved(layer, moves, passages, e)
                if after < 0:
                    if then in rows:
                        ends += _ended(moved, targets, goal, then, (state, t), e)
                elif any(then <= row and np.isfinite(least[after, row - then]) for row in rows):
                    layers.setdefault((after, then), []).append(moved)
    if not ends:
        return None
    cost, at, index, e = min(ends, key=lambda end: end[0])
    edges = _traced(kept, moves, at, index, e)
    taken, bound = moves.passage[edges], float((least[0, rows] + late[rows] * targets.steps_weight).min())
    distance, steps = float(moves.length[edges].sum()), int(moves.steps[edges].sum())
    return Walk(tuple(taken[taken >= 0].tolist()), distance, steps, cost, min(bound, cost))


def _start() -> _Layer:
    zero, none = np.zeros(1), np.full(1, -1)
    return _Layer(zero, zero, zero, np.zeros((1, 2)), none, none)


def _moved(layer: _Layer, moves: Moves, passages: Sequence[Passage], e: int) -> _Layer:
    """The walks of a layer after one move; the placement of a transition adds to theirs."""
    taken = int(moves.passage[e])
    placement = passages[taken].placement if taken >= 0 else Placement(0.0, np.zeros(2))
    shift = rotate_ground(np.broadcast_to(placement.offset, layer.offset.shape), layer.yaw)
    count = len(layer.cost)
    return _Layer(
        layer.cost + float(moves.cost[e]),
        layer.distance + float(moves.length[e]),
        layer.yaw + placement.yaw,
        layer.offset + shift,
        np.full(count, e),
        np.arange(count),
    )


def _thinned(parts: list[_Layer], width: int) -> _Layer:
    """The cheapest of those alike, and of these the `width` cheapest."""
    whole = _Layer(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))
    order = np.argsort(whole.cost, kind="stable")
    turn = whole.yaw % (2 * np.pi)
    cells = np.column_stack([whole.offset, turn, whole.distance])[order] / _ALIKE
    _, first = np.unique(np.floor(cells).astype(np.int64), axis=0, return_index=True)
    chosen = order[np.sort(first)[:width]]
    return _Layer(*(column[chosen] for column in whole))


def _ended(
    moved: _Layer, targets: Targets, goal: Goal, steps: int, at: tuple[int, int], e: int
) -> list[tuple[float, tuple[int, int], int, int]]:
    far = np.nan_to_num(np.abs(moved.distance - targets.distance))
    cost = moved.cost + targets.miss(moved.distance, steps) + goal.miss(moved.yaw, moved.offset)
    cost = np.where(far <= targets.distance_tolerance + 1e-9, cost, np.inf)
    best = int(np.argmin(cost))
    return [(float(cost[best]), at, best, e)] if np.isfinite(cost[best]) else []


def _traced(
    kept: dict[tuple[int, int], _Layer], moves: Moves, at: tuple[int, int], index: int, e: int
) -> np.ndarray:
    edges = [e]
    state, t = at
    while (state, t) != (0, 0):
        layer = kept[state, t]
        e, index = int(layer.move[index]), int(layer.parent[index])
        edges.append(e)
        state, t = int(np.searchsorted(moves.first, e, side="right")) - 1, t - int(moves.steps[e])
    return np.array(edges[::-1])
