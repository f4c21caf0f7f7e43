"""The best transition between two parametric spaces, from where the character is to where it shall be."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from reperform.nodes.kernels.transition_tables import (
    EdgeTables,
    SpaceTables,
    reference_weights,
    stride,
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
    # of best_transition: the next pose in the trellis' direction (-1: none), variance there, squared step and seconds
    beside: np.ndarray
    variance_beside: np.ndarray
    stride: np.ndarray
    pace: np.ndarray
    # first and last + 1 state at each moment; -1 where they are not laid out yet
    begin: np.ndarray
    end: np.ndarray
    # scratch
    corner: np.ndarray
    start: np.ndarray


class Found(NamedTuple):
    """A transition, at poses that are not whole: written in place, so that searching allocates nothing."""

    # leave at this pose and control
    source_pose: np.ndarray
    source_control: np.ndarray
    # enter at this pose and control
    target_pose: np.ndarray
    target_control: np.ndarray
    # E_S, lambda E_L (thousandths), seconds until the transition and seconds from there to the wanted state
    cost: np.ndarray
    # scratch: least cost of every pair of moments, and of every moment of the source
    lower: np.ndarray
    row: np.ndarray


def new_trellis(space: SpaceTables, depth: int, step: float = 0.1) -> Trellis:
    """Room for a trellis of a depth at every pose."""
    d, poses = space.control.shape[1], space.spread.shape[0]
    moments = max(round(depth * step * poses), depth, poses) + 2
    room = moments * (1 + d * (2 + int(1 / step)))
    return Trellis(
        np.zeros(1, np.int64), np.zeros(room, np.int64), np.zeros((room, d)), np.zeros(room),
        np.zeros((room, d + 1), np.int64), np.zeros((room, d + 1)), np.zeros(room), np.zeros(room, np.int64),
        np.zeros(room), np.zeros(room), np.zeros(room), np.zeros(moments, np.int64),
        np.zeros(moments, np.int64), np.zeros(d + 1), np.zeros(d),
    )  # fmt: skip


def new_found(tables: EdgeTables, depth: int = 20, step: float = 0.1) -> Found:
    """Room for a transition, found with trellises up to a depth."""
    source, target = tables.source.control.shape[1], tables.target.control.shape[1]
    moments = [
        max(round(depth * step * side.spread.shape[0]), side.spread.shape[0]) + 2
        for side in (tables.source, tables.target)
    ]
    return Found(
        np.zeros(1), np.zeros(source), np.zeros(1), np.zeros(target), np.zeros(4),
        np.zeros((moments[0], moments[1])), np.zeros(moments[0]),
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
    for k in range(depth + 1):
        at = first + direction * int(np.round(k * step * poses))
        if not space.cyclic and (at < 0 or at > poses - 1):
            break
        _lay_out(space, first, at, direction, control, k, step, out)


@njit(cache=True, nogil=True)
def _lay_out(
    space: SpaceTables,
    first: int,
    at: int,
    direction: int,
    control: np.ndarray,
    changes: int,
    step: float,
    out: Trellis,
) -> None:
    """All states at one moment: the control as it is, and each of its entries up to so many steps away."""
    out.start[:] = control
    _add(space, first, at, direction, out)
    for axis in range(len(control)):
        for side in range(2):
            sign = 2.0 * side - 1.0
            for j in range(1, changes + 1):
                before = min(max(control[axis] + sign * (j - 1) * step, 0.0), 1.0)
                value = min(max(control[axis] + sign * j * step, 0.0), 1.0)
                if abs(value - before) < _SAME:
                    break
                out.start[axis] = value
                _add(space, first, at, direction, out)
        out.start[axis] = control[axis]


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
def _look_on(space: SpaceTables, direction: int, out: Trellis, row: int) -> None:
    """Note what lies beside a state."""
    reference, weight, pose = out.reference[row], out.weight[row], out.pose[row]
    out.beside[row] = _beside(space, pose, direction)
    if out.beside[row] < 0:
        return
    begin = pose if direction > 0 else out.beside[row]
    out.variance_beside[row] = variance(space, out.beside[row], reference, weight)
    out.stride[row] = stride(space, begin, reference, weight)
    pace = 0.0
    for k in range(len(reference)):
        pace += weight[k] * (space.clock[reference[k], begin + 1] - space.clock[reference[k], begin])
    out.pace[row] = pace


@njit(cache=True, nogil=True)
def _beside(space: SpaceTables, pose: int, direction: int) -> int:
    """The next pose in a direction; -1 where a motion that is not cyclic ends."""
    poses = space.spread.shape[0]
    beside = pose + (1 if direction > 0 else -1)
    if space.cyclic:
        return beside % poses
    return beside if 0 <= beside < poses else -1


@njit(cache=True, nogil=True)
def bound(distance: np.ndarray, source: Trellis, s: int, target: Trellis, t: int) -> float:
    """Upper bound of a squared distance: sum_pq r_p r_q D_pq (004 eq 4.5 for the dissimilarity)."""
    total, i, j = 0.0, source.pose[s], target.pose[t]
    for p in range(source.reference.shape[1]):
        row, part = source.reference[s, p], 0.0
        for q in range(target.reference.shape[1]):
            part += target.weight[t, q] * distance[i, row, j, target.reference[t, q]]
        total += source.weight[s, p] * part
    return total


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
            value = bound(tables.distance, source, s, target, t)
            if exact:
                value = max(value - source.variance[s] - target.variance[t], 0.0)
            out[s, t] = value / tables.largest


@njit(cache=True, nogil=True)
def best_transition(
    tables: EdgeTables, source_pose: float, source_control: np.ndarray, target_pose: float, target_control: np.ndarray,
    depth: int, step: float, latency_weight: float, threshold: float, source: Trellis, target: Trellis, found: Found,
) -> bool:  # fmt: skip
    """The transition of least E_S + lambda E_L from a state of the source to a state of the target; False: stay.

    E_S = 1000 dissimilarity, E_L = frames (1/25 s) to the transition and from it to the wanted state. Poses in 0 .. K,
    controls (d,) in 0 .. 1. target_pose < 0: any pose of the target will do, and nothing is counted after the
    transition. Transitions above the threshold (dissimilarity) are refused. source, target, found: room from
    new_trellis and new_found; nothing is allocated.

    Trellises reach `depth` steps, as in `fill_trellis`, but pass every moment: between two poses x, x' of the source and
    two y, y' of the target, a and b of the way on, the cost is a convex polynomial whose least value follows at once,

        |(1 - a) x + a x' - (1 - b) y - b y'|^2
            = (1 - a)(1 - b) D + a (1 - b) D_x' + (1 - a) b D_y' + a b D_x'y' - a (1 - a) |x' - x|^2 - b (1 - b) |y' - y|^2

    Pairs of poses are visited from the least lower bound of their cost (least tabulated distance less what blending can
    gain, quickest way there) until no bound is below the best, so the result is the best of all states though few are
    laid out.

    Source: 004 eqs 4.2, 4.6, section 4.4.1; Land and Doig 1960, Econometrica 28 (branch and bound).
    Departure: dissimilarity is minimised (as printed, a similarity is); all moments, where 004 takes one pose in ten.
    """
    anywhere = target_pose < 0
    first = int(np.floor(source_pose + 0.5))
    last = 0 if anywhere else int(np.floor(target_pose + 0.5))
    poses = tables.target.spread.shape[0]
    m = _moments(tables.source, first, 1, depth, step)
    n = poses if anywhere else _moments(tables.target, last, -1, depth, step)
    latency = latency_weight * RATE
    _lower_bounds(tables, first, last, m, n, anywhere, latency, found.lower)
    for i in range(m):
        found.row[i] = found.lower[i, :n].min()
    source.size[0], target.size[0] = 0, 0
    source.begin[:m], target.begin[:n] = -1, -1
    best = np.inf
    while True:
        i = int(np.argmin(found.row[:m]))
        if found.row[i] >= best:
            break
        j = int(np.argmin(found.lower[i, :n]))
        found.lower[i, j] = np.inf
        found.row[i] = found.lower[i, :n].min()
        if source.begin[i] < 0:
            changes = int(i / (step * tables.source.spread.shape[0]) + _SAME)
            _at_moment(tables.source, first, i, 1, source_control, changes, step, source)
        if target.begin[j] < 0:
            changes = 0 if anywhere else int(j / (step * poses) + _SAME)
            _at_moment(tables.target, j if anywhere else last, 0 if anywhere else j, -1, target_control, changes, step,
                       target, j)  # fmt: skip
        ahead, behind = i + 1 < m, anywhere or j + 1 < n
        best = _cheapest(
            tables, source, i, ahead, target, j, behind, anywhere, latency, threshold, best, found
        )
    return best < np.inf


@njit(cache=True, nogil=True)
def _moments(space: SpaceTables, first: int, direction: int, depth: int, step: float) -> int:
    """Poses that can be reached, with the first."""
    poses = space.spread.shape[0]
    count = int(np.round(depth * step * poses)) + 1
    if space.cyclic:
        return count
    return max(1, min(count, poses - first if direction > 0 else first + 1))


@njit(cache=True, nogil=True)
def _lower_bounds(
    tables: EdgeTables, first: int, last: int, m: int, n: int, anywhere: bool, latency: float, out: np.ndarray
) -> None:
    """What a transition between two moments costs at least."""
    scale = SHAPE / tables.largest
    length, other = tables.source.spread.shape[0], tables.target.spread.shape[0]
    waited = 0.0
    for i in range(m):
        at = (first + i) % length
        passed = 0.0
        for j in range(n):
            to = j if anywhere else (last - j) % other
            if j > 0 and not anywhere:
                passed += tables.target.quickest[to]
            # the pair of poses is entered from here and left towards the pose before
            shape = tables.least[at, (to - 1) % other if tables.target.cyclic else max(to - 1, 0)]
            out[i, j] = max(scale * shape, 0.0) + latency * (waited + passed)
        waited += tables.source.quickest[at]


@njit(cache=True, nogil=True)
def _at_moment(
    space: SpaceTables, first: int, moment: int, direction: int, control: np.ndarray, changes: int, step: float,
    out: Trellis, slot: int = -1,
) -> None:  # fmt: skip
    slot = moment if slot < 0 else slot
    out.begin[slot] = out.size[0]
    _lay_out(space, first, first + direction * moment, direction, control, changes, step, out)
    out.end[slot] = out.size[0]
    for row in range(out.begin[slot], out.end[slot]):
        _look_on(space, direction, out, row)


@njit(cache=True, nogil=True)
def _cheapest(
    tables: EdgeTables, source: Trellis, i: int, ahead: bool, target: Trellis, j: int, behind: bool, anywhere: bool,
    latency: float, threshold: float, best: float, found: Found,
) -> float:  # fmt: skip
    """The least cost from the states of two moments on, if it is below `best`; `found` then holds it.

    ahead, behind: whether the trellises go on to the next pose of the source and to that before of the target.
    """
    scale = SHAPE / tables.largest
    for s in range(source.begin[i], source.end[i]):
        on = ahead and source.beside[s] >= 0
        for t in range(target.begin[j], target.end[j]):
            late = latency * (source.seconds[s] + target.seconds[t])
            if late >= best:
                continue
            back = behind and target.beside[t] >= 0
            p, q = source.pose[s], target.pose[t]
            v, w = source.variance[s], target.variance[t]
            d00 = _bound_at(tables.distance, source, s, p, target, t, q) - v - w
            d10 = d01 = d11 = d00
            fs = ft = slow = slower = 0.0
            if on:
                fs, slow = scale * source.stride[s], latency * source.pace[s]
                d10 = _bound_at(tables.distance, source, s, source.beside[s], target, t, q)
                d10 -= source.variance_beside[s] + w
            if back:
                ft, slower = scale * target.stride[t], 0.0 if anywhere else latency * target.pace[t]
                d01 = _bound_at(tables.distance, source, s, p, target, t, target.beside[t])
                d01 -= v + target.variance_beside[t]
            if on and back:
                d11 = _bound_at(tables.distance, source, s, source.beside[s], target, t, target.beside[t])
                d11 -= source.variance_beside[s] + target.variance_beside[t]
            elif on:
                d11 = d10
            elif back:
                d11 = d01
            if late + scale * min(d00, d10, d01, d11) - 0.25 * (fs + ft) >= best:
                continue
            # scaled shape = c + ga a + gb b + gab a b + fs a^2 + ft b^2
            c, ga, gb = scale * d00, scale * (d10 - d00) - fs, scale * (d01 - d00) - ft
            gab = scale * (d11 - d10 - d01 + d00)
            a, b = _least_within(ga + slow, gb + slower, gab, fs, ft, on, back)
            shape = max(c + ga * a + gb * b + gab * a * b + fs * a * a + ft * b * b, 0.0)
            if shape > SHAPE * threshold:
                # later, where the motions are nearest
                a, b = _least_within(ga, gb, gab, fs, ft, on, back)
                shape = max(c + ga * a + gb * b + gab * a * b + fs * a * a + ft * b * b, 0.0)
            waits = late + slow * a + slower * b
            if shape <= SHAPE * threshold and shape + waits < best:
                best = shape + waits
                found.source_pose[0], found.target_pose[0] = p + a, q - b
                if found.source_pose[0] >= tables.source.spread.shape[0]:
                    found.source_pose[0] -= tables.source.spread.shape[0]
                if found.target_pose[0] < 0.0:
                    found.target_pose[0] += tables.target.spread.shape[0]
                found.source_control[:] = source.control[s]
                found.target_control[:] = target.control[t]
                found.cost[0], found.cost[1] = shape, waits
                found.cost[2] = source.seconds[s] + (a * source.pace[s] if on else 0.0)
                found.cost[3] = target.seconds[t] + (b * target.pace[t] if back and not anywhere else 0.0)
    return best


@njit(cache=True, nogil=True)
def _bound_at(
    distance: np.ndarray, source: Trellis, s: int, i: int, target: Trellis, t: int, j: int
) -> float:
    """As `bound`, at any two poses; apart from it, since a call within it would cost as much as the sum."""
    total = 0.0
    for p in range(source.reference.shape[1]):
        row, part = source.reference[s, p], 0.0
        for q in range(target.reference.shape[1]):
            part += target.weight[t, q] * distance[i, row, j, target.reference[t, q]]
        total += source.weight[s, p] * part
    return total


@njit(cache=True, nogil=True)
def _least_within(
    ga: float, gb: float, gab: float, fs: float, ft: float, on: bool, back: bool
) -> tuple[float, float]:
    """Where ga a + gb b + gab a b + fs a^2 + ft b^2, convex, is least, a and b in 0 .. 1 (0 unless on, back)."""
    determinant = 4.0 * fs * ft - gab * gab
    if on and back and determinant > 1e-12:
        a = (gab * gb - 2.0 * ft * ga) / determinant
        b = (gab * ga - 2.0 * fs * gb) / determinant
        if 0.0 <= a <= 1.0 and 0.0 <= b <= 1.0:
            return a, b
    # else on a side
    x, y, least = 0.0, 0.0, np.inf
    for side in range(4):
        end = float(side % 2)
        if side < 2:
            b = end if back else 0.0
            a = _least_of(ga + gab * b, fs) if on else 0.0
        else:
            a = end if on else 0.0
            b = _least_of(gb + gab * a, ft) if back else 0.0
        value = ga * a + gb * b + gab * a * b + fs * a * a + ft * b * b
        if value < least:
            x, y, least = a, b, value
    return x, y


@njit(cache=True, nogil=True)
def _least_of(g: float, f: float) -> float:
    """Where g u + f u^2 is least in 0 .. 1."""
    if f <= 0.0:
        return 0.0 if g >= 0.0 else 1.0
    return min(max(-g / (2.0 * f), 0.0), 1.0)
