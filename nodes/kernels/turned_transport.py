"""Earth mover's distances between all pairs of frames, least over turns about the vertical."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from reperform.nodes.kernels.signatures import Signatures
from reperform.nodes.kernels.transport import earth_movers, row_potentials


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
    supply, demand, cost = _problem(a, i, b, j)
    return earth_movers(supply, demand, cost, above)


@njit(cache=True, nogil=True)
def _problem(a: Signatures, i: int, b: Signatures, j: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    x, y = a.point[a.first[i] : a.first[i + 1]], b.point[b.first[j] : b.first[j + 1]]
    cost = np.empty((len(x), len(y)))
    columns = np.ascontiguousarray(y.T)
    for p in range(len(x)):
        _distances(x[p], columns, cost[p])
    return a.mass[a.first[i] : a.first[i + 1]], b.mass[b.first[j] : b.first[j + 1]], cost


@njit(cache=True, nogil=True)
def _distances(x: np.ndarray, y: np.ndarray, out: np.ndarray) -> None:
    """How far x (6,) is from every column of y (6, M)."""
    x0, x1, x2, x3, x4, x5 = x[0], x[1], x[2], x[3], x[4], x[5]
    for q in range(y.shape[1]):
        square = (x0 - y[0, q]) ** 2 + (x1 - y[1, q]) ** 2 + (x2 - y[2, q]) ** 2
        square += (x3 - y[3, q]) ** 2 + (x4 - y[4, q]) ** 2 + (x5 - y[5, q]) ** 2
        out[q] = math.sqrt(square)


@njit(cache=True, nogil=True)
def least_distance(
    a: Signatures, i: int, b: Signatures, j: int, cells: tuple[Signatures, Signatures], turns: int
) -> tuple[float, int, int]:
    """The least distance of frame i of a from frame j of `turned` b over all turns, that turn, and how many turns
    had to be solved to prove it; `cells` are a and `turned` b by cells.

    Turns are solved in the order of their lower bounds, until the next bound is over the least found.
    """
    stride = (len(b.first) - 1) // turns
    bounds = np.empty(turns)
    for k in range(turns):
        bounds[k] = distance_bound(a, i, b, k * stride + j, cells)
    least, best, solved = np.inf, -1, 0
    for k in np.argsort(bounds, kind="mergesort"):
        if bounds[k] > least:
            break
        value = signature_distance(a, i, b, k * stride + j, least)
        solved += 1
        if value < least:
            least, best = value, k
    return least, best, solved


@njit(cache=True, nogil=True)
def distance_bound(
    a: Signatures, i: int, b: Signatures, j: int, cells: tuple[Signatures, Signatures]
) -> float:
    """A lower bound of the earth mover's distance of frame i of a from frame j of b, from that of their cells.

        EMD >= sum_i supply_i u_i + sum_j demand_j v_j   wherever u_i + v_j <= |x_i - y_j|

    The potentials u_p of the cells c_p of a are carried to the points of b, then to those of a and back:

        v_j = min_p |c_p - y_j| - u_p,   u_i = min_j |x_i - y_j| - v_j,   v_j = min_i |x_i - y_j| - u_i

    Source: Villani 2009, Optimal Transport, definition 5.2 (c-transform) and theorem 5.10.
    """
    supply, demand, cost = _problem(cells[0], i, cells[1], j)
    known = row_potentials(supply, demand, cost)
    centre = cells[0].point[cells[0].first[i] : cells[0].first[i + 1]]
    x, y = a.point[a.first[i] : a.first[i + 1]], b.point[b.first[j] : b.first[j + 1]]
    columns = np.ascontiguousarray(y.T)
    away, carried, back = np.empty(len(y)), np.full(len(y), np.inf), np.full(len(y), np.inf)
    for p in range(len(centre)):
        _distances(centre[p], columns, away)
        for q in range(len(y)):
            carried[q] = min(carried[q], away[q] - known[p])
    total = 0.0
    for p in range(len(x)):
        _distances(x[p], columns, away)
        u = np.inf
        for q in range(len(y)):
            u = min(u, away[q] - carried[q])
        for q in range(len(y)):
            back[q] = min(back[q], away[q] - u)
        total += a.mass[a.first[i] + p] * u
    for q in range(len(y)):
        total += b.mass[b.first[j] + q] * back[q]
    return total


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


@njit(cache=True, nogil=True)
def exact_distances(
    takes: tuple[Signatures, Signatures], cells: tuple[Signatures, Signatures], turns: int, pairs: np.ndarray
) -> np.ndarray:
    """Distances (P,) of pairs (P, 2) of a frame of a and one of `turned` b, of all points and proved least over the
    turns; `cells` are both by cells.
    """
    distance = np.empty(len(pairs))
    for k in range(len(pairs)):
        distance[k] = least_distance(takes[0], pairs[k, 0], takes[1], pairs[k, 1], cells, turns)[0]
    return distance
