"""The best transition between two parametric spaces, from where the character is to where it shall be."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from reperform.nodes.kernels.transition_tables import (
    EdgeTables,
    SpaceTables,
    bound,
    reference_weights,
    variance,
)  # fmt: skip

# costs of shape are thousandths of the greatest dissimilarity, latencies are counted in frames of this rate
SHAPE = 1000.0
RATE = 25.0
_SAME = 1e-9


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


class Found(NamedTuple):
    """A transition: written in place, so that searching allocates nothing."""

    # leave at this pose and control
    source_pose: np.ndarray
    source_control: np.ndarray
    # enter at this pose and control
    target_pose: np.ndarray
    target_control: np.ndarray
    # E_S, lambda E_L (thousandths), seconds until the transition and seconds from there to the wanted state
    cost: np.ndarray


def new_trellis(space: SpaceTables, depth: int) -> Trellis:
    """Room for a trellis of a depth, or for all poses of the space."""
    d = space.control.shape[1]
    room = max((depth + 1) * (1 + 2 * d * depth), space.spread.shape[0])
    return Trellis(
        np.zeros(1, np.int64), np.zeros(room, np.int64), np.zeros((room, d)), np.zeros(room),
        np.zeros((room, d + 1), np.int64), np.zeros((room, d + 1)), np.zeros(room), np.zeros(d + 1), np.zeros(d),
    )  # fmt: skip


def new_found(tables: EdgeTables) -> Found:
    """Room for a transition."""
    source, target = tables.source.control.shape[1], tables.target.control.shape[1]
    return Found(
        np.zeros(1, np.int64), np.zeros(source), np.zeros(1, np.int64), np.zeros(target), np.zeros(4)
    )


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
    for k in range(depth + 1):
        at = first + direction * int(np.round(k * step * poses))
        if not space.cyclic and (at < 0 or at > poses - 1):
            break
        out.start[:] = control
        _add(space, first, at, direction, out)
        for axis in range(len(control)):
            for sign in (-1.0, 1.0):
                for j in range(1, k + 1):
                    before = min(max(control[axis] + sign * (j - 1) * step, 0.0), 1.0)
                    value = min(max(control[axis] + sign * j * step, 0.0), 1.0)
                    if abs(value - before) < _SAME:
                        break
                    out.start[:] = control
                    out.start[axis] = value
                    _add(space, first, at, direction, out)


@njit(cache=True, nogil=True)
def fill_poses(space: SpaceTables, control: np.ndarray, first: int, last: int, out: Trellis) -> None:
    """The poses first .. last of a space at one control, all of them at once: where the wanted state does not matter."""
    out.size[0] = 0
    for pose in range(max(first, 0), min(last, space.spread.shape[0] - 1) + 1):
        out.start[:] = control
        _add(space, pose, pose, 1, out)


@njit(cache=True, nogil=True)
def _add(space: SpaceTables, first: int, at: int, direction: int, out: Trellis) -> None:
    row, poses = out.size[0], space.spread.shape[0]
    reference, weight = out.reference[row], out.weight[row]
    reference_weights(space, out.start, out.corner, reference, weight)
    # the clock covers two runs: shift both ends into them
    early, late = (first, at) if direction > 0 else (at, first)
    shift = -int(np.floor(early / poses)) * poses
    early, late, runs = early + shift, late + shift, 0
    while late > 2 * poses:
        late -= poses
        runs += 1
    seconds = 0.0
    for k in range(len(reference)):
        clock = space.clock[reference[k]]
        seconds += weight[k] * (clock[late] - clock[early] + runs * clock[poses])
    pose = at % poses
    out.pose[row], out.seconds[row] = pose, seconds
    out.control[row] = out.start
    out.variance[row] = variance(space, pose, reference, weight)
    out.size[0] = row + 1


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
    for s in range(source.size[0]):
        for t in range(target.size[0]):
            value = bound(
                tables.distance, source.pose[s], source.reference[s], source.weight[s],
                target.pose[t], target.reference[t], target.weight[t],
            )  # fmt: skip
            if exact:
                value = max(value - source.variance[s] - target.variance[t], 0.0)
            out[s, t] = value / tables.largest


@njit(cache=True, nogil=True)
def cheapest(
    tables: EdgeTables,
    source: Trellis,
    target: Trellis,
    latency_weight: float,
    threshold: float,
    found: Found,
) -> bool:
    """The transition of least E_S + lambda E_L between the states of two trellises; False where none is allowed.

    E_S = 1000 dissimilarity, E_L = frames (1/25 s) to the transition and from it to the wanted state. Transitions
    above the threshold are refused. Pairs of poses whose least tabulated distance cannot beat the best so far are passed
    over.

    Source: 004 eqs 4.2, 4.6. Departure: dissimilarity is minimised (as printed, a similarity is).
    """
    best, scale = np.inf, SHAPE / tables.largest
    for s in range(source.size[0]):
        waited = latency_weight * RATE * source.seconds[s]
        if waited >= best:
            continue
        for t in range(target.size[0]):
            latency = waited + latency_weight * RATE * target.seconds[t]
            apart = source.variance[s] + target.variance[t]
            if (
                scale * (tables.least[source.pose[s], target.pose[t]] - apart) + latency >= best
                or latency >= best
            ):
                continue
            value = bound(
                tables.distance, source.pose[s], source.reference[s], source.weight[s],
                target.pose[t], target.reference[t], target.weight[t],
            )  # fmt: skip
            value = max(value - apart, 0.0) / tables.largest
            if value <= threshold and SHAPE * value + latency < best:
                best = SHAPE * value + latency
                found.source_pose[0], found.target_pose[0] = source.pose[s], target.pose[t]
                found.source_control[:] = source.control[s]
                found.target_control[:] = target.control[t]
                found.cost[0], found.cost[1] = SHAPE * value, latency
                found.cost[2], found.cost[3] = source.seconds[s], target.seconds[t]
    return best < np.inf


@njit(cache=True, nogil=True)
def best_transition(
    tables: EdgeTables, source_pose: float, source_control: np.ndarray, target_pose: float, target_control: np.ndarray,
    depth: int, step: float, latency_weight: float, threshold: float, source: Trellis, target: Trellis, found: Found,
) -> bool:  # fmt: skip
    """The best transition from a state of the source space to a state of the target space; False: stay.

    Poses in 0 .. K, controls (d,) in 0 .. 1. target_pose < 0: any pose of the target will do, and nothing is counted
    after the transition. source, target, found: room from new_trellis and new_found; nothing is allocated.
    """
    fill_trellis(tables.source, source_pose, source_control, 1, depth, step, source)
    if target_pose < 0:
        fill_poses(tables.target, target_control, 0, tables.target.spread.shape[0] - 1, target)
    else:
        fill_trellis(tables.target, target_pose, target_control, -1, depth, step, target)
    return cheapest(tables, source, target, latency_weight, threshold, found)
