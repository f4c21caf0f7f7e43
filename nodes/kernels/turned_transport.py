"""Earth mover's distances between all pairs of frames, least over turns about the vertical."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from reperform.nodes.kernels.signatures import Signatures
from reperform.nodes.kernels.transport import earth_movers


@njit(cache=True, nogil=True)
def turned_cost(a: np.ndarray, b: np.ndarray, yaw: float) -> np.ndarray:
    """Distances (N, M) of points a (N, 6) from b (M, 6), whose x and z (columns 0 and 2) are first turned by
    `yaw` about y.
    """
    cost = np.empty((len(a), len(b)))
    c, s = math.cos(yaw), math.sin(yaw)
    for j in range(len(b)):
        x, z = c * b[j, 0] + s * b[j, 2], -s * b[j, 0] + c * b[j, 2]
        for i in range(len(a)):
            square = (a[i, 0] - x) ** 2 + (a[i, 2] - z) ** 2 + (a[i, 1] - b[j, 1]) ** 2
            square += (a[i, 3] - b[j, 3]) ** 2 + (a[i, 4] - b[j, 4]) ** 2 + (a[i, 5] - b[j, 5]) ** 2
            cost[i, j] = math.sqrt(square)
    return cost


@njit(cache=True, nogil=True)
def least_turn(
    mass_a: np.ndarray,
    point_a: np.ndarray,
    mass_b: np.ndarray,
    point_b: np.ndarray,
    turns: int,
    order: np.ndarray,
    tried: int,
) -> tuple[float, int]:
    """The least distance over the first `tried` turns of `order`, and that turn k (by 2 pi k / turns)."""
    least, best = np.inf, -1
    for n in range(tried):
        k = order[n]
        cost = turned_cost(point_a, point_b, 2 * math.pi * k / turns)
        value = earth_movers(mass_a, mass_b, cost, least)
        if value < least:
            least, best = value, k
    return least, best


@njit(cache=True, nogil=True)
def turn_values(
    mass_a: np.ndarray, point_a: np.ndarray, mass_b: np.ndarray, point_b: np.ndarray, turns: int
) -> np.ndarray:
    """The distance at each of the turns (turns,)."""
    values = np.empty(turns)
    for k in range(turns):
        cost = turned_cost(point_a, point_b, 2 * math.pi * k / turns)
        values[k] = earth_movers(mass_a, mass_b, cost, np.inf)
    return values


@njit(cache=True, nogil=True)
def turned_transport(
    a: Signatures,
    b: Signatures,
    coarse_a: Signatures,
    coarse_b: Signatures,
    turns: int,
    margin: float,
    same: bool,
    first: int,
    last: int,
) -> tuple[np.ndarray, np.ndarray]:
    """Distances of frames first .. last - 1 of a from all frames of b, and the turns of b that give them.

    The coarse signatures say which turns are tried on the fine ones: those whose coarse distance is at most
    `margin` times the least. With `same` (a is b) only frames of b after that of a are filled in.
    """
    columns = len(b.first) - 1
    distance = np.zeros((last - first, columns))
    turned = np.zeros((last - first, columns), np.int32)
    for i in range(first, last):
        ra, ca = slice(a.first[i], a.first[i + 1]), slice(coarse_a.first[i], coarse_a.first[i + 1])
        for j in range(i + 1 if same else 0, columns):
            rb, cb = slice(b.first[j], b.first[j + 1]), slice(coarse_b.first[j], coarse_b.first[j + 1])
            values = turn_values(
                coarse_a.mass[ca], coarse_a.point[ca], coarse_b.mass[cb], coarse_b.point[cb], turns
            )
            order = np.argsort(values, kind="mergesort")
            tried = 1
            while tried < turns and values[order[tried]] <= margin * values[order[0]]:
                tried += 1
            distance[i - first, j], turned[i - first, j] = least_turn(
                a.mass[ra], a.point[ra], b.mass[rb], b.point[rb], turns, order, tried
            )
    return distance, turned
