"""Earth mover's distances between all pairs of frames, least over turns about the vertical."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from reperform.nodes.kernels.signatures import Signatures
from reperform.nodes.kernels.transport import earth_movers


def turned(take: Signatures, turns: int) -> Signatures:
    """All frames of a take at each of the turns: frame t turned by 2 pi k / turns about y is frame k T + t.

    Columns 0 and 2 of the points are x and z; a positive turn leads from z towards x.
    """
    points = []
    for k in range(turns):
        c, s = math.cos(2 * math.pi * k / turns), math.sin(2 * math.pi * k / turns)
        point = take.point.copy()
        point[:, 0] = c * take.point[:, 0] + s * take.point[:, 2]
        point[:, 2] = -s * take.point[:, 0] + c * take.point[:, 2]
        points.append(point)
    starts = [take.first[:-1] + k * take.first[-1] for k in range(turns)]
    first = np.concatenate([*starts, [turns * take.first[-1]]])
    return Signatures(first, np.tile(take.mass, turns), np.concatenate(points))


@njit(cache=True, nogil=True)
def signature_distance(a: Signatures, i: int, b: Signatures, j: int, above: float) -> float:
    """The earth mover's distance of frame i of a from frame j of b; inf where it is proved to be over `above`."""
    n, m = a.first[i + 1] - a.first[i], b.first[j + 1] - b.first[j]
    cost = np.empty((n, m))
    for p in range(n):
        x = a.point[a.first[i] + p]
        for q in range(m):
            y = b.point[b.first[j] + q]
            square = (x[0] - y[0]) ** 2 + (x[1] - y[1]) ** 2 + (x[2] - y[2]) ** 2
            square += (x[3] - y[3]) ** 2 + (x[4] - y[4]) ** 2 + (x[5] - y[5]) ** 2
            cost[p, q] = math.sqrt(square)
    supply, demand = a.mass[a.first[i] : a.first[i + 1]], b.mass[b.first[j] : b.first[j + 1]]
    return earth_movers(supply, demand, cost, above)


@njit(cache=True, nogil=True)
def least_turn(
    a: Signatures, i: int, b: Signatures, j: int, turns: int, order: np.ndarray
) -> tuple[float, int]:
    """The least distance of frame i of a from frame j of `turned` b over the turns in `order`, and that turn."""
    stride = (len(b.first) - 1) // turns
    least, best = np.inf, -1
    for k in order:
        value = signature_distance(a, i, b, k * stride + j, least)
        if value < least:
            least, best = value, k
    return least, best


@njit(cache=True, nogil=True)
def promising_turns(
    a: Signatures, i: int, b: Signatures, j: int, turns: int, among: np.ndarray, margin: float
) -> np.ndarray:
    """Those of some turns, least first, whose distance of frame i of a from frame j of `turned` b is at most
    `margin` times the least.
    """
    stride = (len(b.first) - 1) // turns
    values = np.empty(len(among))
    for n in range(len(among)):
        values[n] = signature_distance(a, i, b, among[n] * stride + j, np.inf)
    order = np.argsort(values, kind="mergesort")
    kept = 1
    while kept < len(among) and values[order[kept]] <= margin * values[order[0]]:
        kept += 1
    return among[order[:kept]]


@njit(cache=True, nogil=True)
def turned_transport(
    rough: tuple[Signatures, Signatures],
    middle: tuple[Signatures, Signatures],
    fine: tuple[Signatures, Signatures],
    turns: int,
    margins: tuple[float, float],
    same: bool,
) -> np.ndarray:
    """Distances (Ta, Tb) of all frames of a from all frames of b, least over the turns; pairs of a and `turned` b.

    The rough signatures say which turns are tried on the middle ones and these which on the fine ones: those whose
    distance is at most the margin times the least. Since b is turned and not a, cells may differ a little from those
    of the swapped pair. With `same` (a is b) only frames of b after that of a are filled in.
    """
    rows, columns = len(fine[0].first) - 1, (len(fine[1].first) - 1) // turns
    distance = np.zeros((rows, columns))
    for i in range(rows):
        for j in range(i + 1 if same else 0, columns):
            order = promising_turns(rough[0], i, rough[1], j, turns, np.arange(turns), margins[0])
            if len(order) > 1:
                order = promising_turns(middle[0], i, middle[1], j, turns, order, margins[1])
            distance[i, j] = least_turn(fine[0], i, fine[1], j, turns, order)[0]
    return distance
