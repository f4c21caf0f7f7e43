"""How far bodies get in a number of frames, and so how near a curve they can come at best."""

from __future__ import annotations

import numpy as np
from numba import njit

from reperform.nodes.kernels.graph_moves import Moves


def curve_reach(moves: Moves, frames: int) -> np.ndarray:
    """The longest way (N, frames + 1), m, that a body goes from each captured frame in 0, 1, ... frames.

    Where a take ends with no move on, bodies stay.
    """
    step = np.linalg.norm(np.diff(moves.middle[:, [0, 2]], axis=0), axis=1)
    return _reach(moves.leaving, moves.target, moves.first, np.concatenate([[0.0], np.cumsum(step)]), frames)


@njit(cache=True, nogil=True)
def _reach(
    leaving: np.ndarray, target: np.ndarray, first: np.ndarray, along: np.ndarray, frames: int
) -> np.ndarray:
    count = len(leaving) - 1
    out = np.zeros((count, frames + 1))
    for k in range(1, frames + 1):
        for i in range(count):
            for e in range(leaving[i], leaving[i + 1]):
                begin, played = first[e], min(k, first[e + 1] - 1 - first[e])
                way = along[begin + played] - along[begin] + out[target[e], k - played]
                out[i, k] = max(out[i, k], way)
    return out


@njit(cache=True, nogil=True)
def distance_left(
    points: np.ndarray, step: float, length: float, reach: np.ndarray, s: float, x: float, z: float
) -> float:
    """A lower bound of the sum of distances from a curve, m, over the frames still to come up to its end.

        sum over frames k of max(0, |curve(s + reach_k) - body| - reach_k)

    points (M, 2) of the curve every `step` m; reach: a row of curve_reach; s: arc length walked; x, z: the body. After
    k frames the body has walked a <= reach_k further and is within a of where it was; |curve(s + a) - body| - a falls
    as a grows, as the curve's points part no faster than its length grows.
    """
    total, last = 0.0, points.shape[0] - 1
    for k in range(1, len(reach)):
        if s + reach[k - 1] >= length:
            break
        place = min((s + reach[k]) / step, last - 1e-9)
        i = int(place)
        part = place - i
        gx = (1 - part) * points[i, 0] + part * points[i + 1, 0] - x
        gz = (1 - part) * points[i, 1] + part * points[i + 1, 1] - z
        gap = np.sqrt(gx * gx + gz * gz) - reach[k]
        if gap <= 0.0:
            break
        total += gap
    return total
