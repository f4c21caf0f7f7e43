"""The states of a parametric space that can be reached within some steps, and how alike those of two spaces are."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from reperform.nodes.kernels.transition_tables import EdgeTables, SpaceTables, clock_span, reference_weights

# controls no further apart are the same
SAME = 1e-9


class Trellis(NamedTuple):
    """States that can be reached (or from which a state can be reached), with the time it takes; the first `size[0]`."""

    size: np.ndarray
    pose: np.ndarray
    control: np.ndarray
    seconds: np.ndarray
    reference: np.ndarray
    weight: np.ndarray
    variance: np.ndarray
    # scratch
    corner: np.ndarray
    start: np.ndarray


def new_trellis(space: SpaceTables, depth: int, step: float = 0.1) -> Trellis:
    """Room for a trellis of a depth at every pose."""
    d, poses = space.control.shape[1], space.spread.shape[0]
    moments = max(round(depth * step * poses), depth, poses) + 2
    room = moments * (1 + d * (2 + int(1 / step)))
    return Trellis(
        np.zeros(1, np.int64), np.zeros(room, np.int64), np.zeros((room, d)), np.zeros(room),
        np.zeros((room, d + 1), np.int64), np.zeros((room, d + 1)), np.zeros(room), np.zeros(d + 1), np.zeros(d),
    )  # fmt: skip


@njit(cache=True, nogil=True)
def fill_trellis(
    space: SpaceTables,
    pose: float,
    control: np.ndarray,
    direction: int,
    depth: int,
    step: float,
    out: Trellis,
) -> None:
    """States within `depth` steps after (direction 1) or before (-1) a state.

    After k steps: k step K poses on, and one control moved by up to k steps of its range, within 0 .. 1. Poses of a
    space that is not cyclic end where the take ends.

    Source: 004 section 4.4.1 (step 0.1).
    Departure: controls move one at a time, so that states grow as k d and not as k^d.
    """
    poses = space.spread.shape[0]
    first = int(np.floor(pose + 0.5))
    out.size[0] = 0
    before = 0
    for k in range(depth + 1):
        at = first + direction * int(np.round(k * step * poses))
        if not space.cyclic and (at < 0 or at > poses - 1):
            break
        start = out.size[0]
        _lay_out(space, control, k, step, before, out)
        _time(space, first, at, direction, start, out)
        before = start


@njit(cache=True, nogil=True)
def _lay_out(
    space: SpaceTables, control: np.ndarray, changes: int, step: float, before: int, out: Trellis
) -> None:
    """Controls at one moment: as it is, and each of its entries up to so many steps away; those within fewer steps are
    in the rows of the moment before, in the same order.
    """
    row = out.size[0]
    out.start[:] = control
    if changes == 0:
        _locate(space, row, out)
    else:
        _repeat(before, row, out)
    row, before = row + 1, before + 1
    for axis in range(len(control)):
        for side in range(2):
            sign = 2.0 * side - 1.0
            for j in range(1, changes + 1):
                nearer = min(max(control[axis] + sign * (j - 1) * step, 0.0), 1.0)
                value = min(max(control[axis] + sign * j * step, 0.0), 1.0)
                if abs(value - nearer) < SAME:
                    break
                if j < changes:
                    _repeat(before, row, out)
                    before += 1
                else:
                    out.start[axis] = value
                    _locate(space, row, out)
                row += 1
        out.start[axis] = control[axis]
    out.size[0] = row


@njit(cache=True, nogil=True)
def _locate(space: SpaceTables, row: int, out: Trellis) -> None:
    """The control `start` and the references between which it lies."""
    out.control[row] = out.start
    reference_weights(space, out.start, out.corner, out.reference[row], out.weight[row])


@njit(cache=True, nogil=True)
def _repeat(known: int, row: int, out: Trellis) -> None:
    """The control of another row."""
    for k in range(out.control.shape[1]):
        out.control[row, k] = out.control[known, k]
    for k in range(out.reference.shape[1]):
        out.reference[row, k], out.weight[row, k] = out.reference[known, k], out.weight[known, k]


@njit(cache=True, nogil=True)
def _time(space: SpaceTables, first: int, at: int, direction: int, start: int, out: Trellis) -> None:
    """Pose, seconds and variance of all states of one moment, from row `start` on."""
    poses = space.spread.shape[0]
    early, late, runs = clock_span(first, at, direction, poses)
    pose = at % poses
    for row in range(start, out.size[0]):
        seconds = spread = 0.0
        for k in range(out.reference.shape[1]):
            p, weight = out.reference[row, k], out.weight[row, k]
            seconds += weight * (space.clock[p, late] - space.clock[p, early] + runs * space.clock[p, poses])
            for q in range(k):
                spread += weight * out.weight[row, q] * space.spread[pose, p, out.reference[row, q]]
        out.pose[row], out.seconds[row], out.variance[row] = pose, seconds, spread


@njit(cache=True, nogil=True)
def dissimilarities(
    tables: EdgeTables, source: Trellis, target: Trellis, exact: bool, out: np.ndarray
) -> None:
    """Dissimilarity of every source state from every target state: out (states, states), squared distance / largest.

    exact: D = sum_pq r_p r_q D_pq - var_p - var_q, what the played mesh has (a blend of references) to rounding; else
    the upper bound of it without the variances.

    Source: 004 eq 4.5 (the bound). Departure: the identity |sum r_p x_p - y|^2 = sum r_p |x_p - y|^2 - var, which the
    proof of eq 4.5 (appendix A) drops, makes the bound exact for two numbers more per state.
    """
    blended = np.empty(tables.distance.shape[3])
    for s in range(source.size[0]):
        i, moment = source.pose[s], -1
        for t in range(target.size[0]):
            j = target.pose[t]
            if j != moment:
                moment = j
                for q in range(len(blended)):
                    blended[q] = 0.0
                    for p in range(source.reference.shape[1]):
                        blended[q] += source.weight[s, p] * tables.distance[i, source.reference[s, p], j, q]
            value = 0.0
            for q in range(target.reference.shape[1]):
                value += target.weight[t, q] * blended[target.reference[t, q]]
            if exact:
                value = max(value - source.variance[s] - target.variance[t], 0.0)
            out[s, t] = value / tables.largest
