"""The best transition between two parametric spaces, from where the character is to where it shall be."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from reperform.nodes.kernels.transition_tables import EdgeTables, SpaceTables, clock_span, reference_weights
from reperform.nodes.kernels.trellis import SAME

# costs of shape are thousandths of the greatest dissimilarity, latencies are counted in frames of this rate
SHAPE = 1000.0
RATE = 25.0


class Reach(NamedTuple):
    """Controls in reach, by the number of steps to them, and what holds for them at each moment: room for a search."""

    # (controls, d), the first `within[k, 0]` of which are within k steps
    control: np.ndarray
    within: np.ndarray
    # (controls, d + 1): references between which they lie, numbered as in `used`, and weights
    place: np.ndarray
    weight: np.ndarray
    # references, in order of their first use; `within[k, 1]` of them within k steps
    used: np.ndarray
    # (references,) number in `used`; -1: none
    number: np.ndarray
    # (moments, controls, 5): see _SECONDS .. _PACE; and how many controls are laid out at each moment
    state: np.ndarray
    laid: np.ndarray
    # scratch
    start: np.ndarray
    corner: np.ndarray
    reference: np.ndarray


# of a state: seconds to or from it, variance here and at the next pose in the trellis' direction, squared step to that
# pose and seconds of that step
_SECONDS, _VARIANCE, _BESIDE, _STRIDE, _PACE = range(5)


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
    # (target controls, source references, 4): distances of a target state from the references, at both poses of both
    part: np.ndarray
    source: Reach
    target: Reach


def new_found(tables: EdgeTables, depth: int = 20, step: float = 0.1) -> Found:
    """Room for a transition, found with trellises up to a depth."""
    source, target = (_new_reach(side, depth, step) for side in (tables.source, tables.target))
    return Found(
        np.zeros(1), np.zeros(source.control.shape[1]), np.zeros(1), np.zeros(target.control.shape[1]), np.zeros(4),
        np.zeros((len(source.laid), len(target.laid))), np.zeros(len(source.laid)),
        np.zeros((len(target.control), len(source.number), 4)), source, target,
    )  # fmt: skip


def _new_reach(space: SpaceTables, depth: int, step: float) -> Reach:
    poses, references, d = space.spread.shape[0], *space.control.shape
    moments, room = max(round(depth * step * poses), poses) + 2, 1 + d * (2 + int(1 / step))
    return Reach(
        np.zeros((room, d)), np.zeros((depth + 2, 2), np.int64), np.zeros((room, d + 1), np.int64),
        np.zeros((room, d + 1)), np.zeros(references, np.int64), np.zeros(references, np.int64),
        np.zeros((moments, room, 5)), np.zeros(moments, np.int64), np.zeros(d), np.zeros(d + 1),
        np.zeros(d + 1, np.int64),
    )  # fmt: skip


@njit(cache=True, nogil=True)
def best_transition(
    tables: EdgeTables, source_pose: float, source_control: np.ndarray, target_pose: float, target_control: np.ndarray,
    depth: int, step: float, latency_weight: float, threshold: float, found: Found,
) -> bool:  # fmt: skip
    """The transition of least E_S + lambda E_L from a state of the source to a state of the target; False: stay.

    E_S = 1000 dissimilarity, E_L = frames (1/25 s) to the transition and from it to the wanted state. Poses in 0 .. K,
    controls (d,) in 0 .. 1. target_pose < 0: any pose of the target will do, and nothing is counted after the
    transition. Transitions above the threshold (dissimilarity) are refused. found: room from new_found; nothing is
    allocated.

    Trellises reach `depth` steps, as in `trellis.fill_trellis`, but pass every moment: between two poses x, x' of the source and
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
    source, target = found.source, found.target
    length, poses = tables.source.spread.shape[0], tables.target.spread.shape[0]
    m = _moments(tables.source, first, 1, depth, step)
    n = poses if anywhere else _moments(tables.target, last, -1, depth, step)
    latency = latency_weight * RATE
    _lower_bounds(tables, first, last, m, n, anywhere, latency, found.lower, found.row)
    source.laid[:m], target.laid[:n] = 0, 0
    source.number[:], target.number[:] = -1, -1
    source_steps = target_steps = -1
    best = np.inf
    while True:
        i = 0
        for k in range(1, m):
            if found.row[k] < found.row[i]:
                i = k
        if found.row[i] >= best:
            break
        j = _take_least(found.lower[i, :n], found.row, i)
        changes = int(i / (step * length) + SAME)
        change = 0 if anywhere else int(j / (step * poses) + SAME)
        on = i + 1 < m
        back = (tables.target.cyclic or j > 0) if anywhere else j + 1 < n
        if source.laid[i] == 0:
            source_steps = _widen(tables.source, source_control, source_steps, changes, step, source)
            _lay_out_moment(tables.source, first, first + i, 1, on, True, changes, source, i)
        if target.laid[j] == 0:
            target_steps = _widen(tables.target, target_control, target_steps, change, step, target)
            at = j if anywhere else last - j
            _lay_out_moment(
                tables.target, at if anywhere else last, at, -1, back, not anywhere, change, target, j
            )
        here, there = (first + i) % length, (j if anywhere else last - j) % poses
        best = _cheapest(
            tables.distance, tables.largest, i, here, (here + 1) % length if on else here, source.within[changes, 1],
            j, there, (there - 1) % poses if back else there, on, back, latency, threshold, best, found,
        )  # fmt: skip
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
    tables: EdgeTables, first: int, last: int, m: int, n: int, anywhere: bool, latency: float, out: np.ndarray,
    row: np.ndarray,
) -> None:  # fmt: skip
    """What a transition between two moments costs at least, and from each moment of the source: out (m, n), row (m,)."""
    scale = SHAPE / tables.largest
    length, other = tables.source.spread.shape[0], tables.target.spread.shape[0]
    cyclic, quickest, least = tables.target.cyclic, tables.target.quickest, tables.least
    start, way = (0, 1) if anywhere else (last % other, -1)
    waited, at = 0.0, first % length
    for i in range(m):
        passed, to, low = 0.0, start, np.inf
        for j in range(n):
            if j > 0 and not anywhere:
                passed += quickest[to]
            # the pair of poses is entered from here and left towards the pose before
            before = to - 1
            if before < 0:
                before = other - 1 if cyclic else 0
            value = max(scale * least[at, before], 0.0) + latency * (waited + passed)
            out[i, j] = value
            if value < low:
                low = value
            to += way
            if to < 0:
                to = other - 1
        row[i] = low
        waited += tables.source.quickest[at]
        at = at + 1 if at + 1 < length else 0


@njit(cache=True, nogil=True)
def _take_least(values: np.ndarray, row: np.ndarray, i: int) -> int:
    """Where values are least; there they become infinite, and row[i] the least of the others."""
    least = 0
    second = np.inf
    for j in range(1, len(values)):
        if values[j] < values[least]:
            second = values[least]
            least = j
        elif values[j] < second:
            second = values[j]
    values[least], row[i] = np.inf, second
    return least


@njit(cache=True, nogil=True)
def _widen(space: SpaceTables, control: np.ndarray, known: int, steps: int, step: float, out: Reach) -> int:
    """Add controls until all within so many steps are known; the steps that are known then."""
    for j in range(known + 1, steps + 1):
        count = uses = 0
        if j > 0:
            count, uses = out.within[j - 1, 0], out.within[j - 1, 1]
        for axis in range(len(control)):
            for side in range(2):
                sign = 2.0 * side - 1.0
                value = control[axis]
                if j > 0:
                    before = min(max(control[axis] + sign * (j - 1) * step, 0.0), 1.0)
                    value = min(max(control[axis] + sign * j * step, 0.0), 1.0)
                    if abs(value - before) < SAME:
                        continue
                elif axis + side > 0:
                    continue
                out.start[:] = control
                out.start[axis] = value
                out.control[count] = out.start
                reference_weights(space, out.start, out.corner, out.reference, out.weight[count])
                for k in range(len(out.reference)):
                    reference = out.reference[k]
                    if out.number[reference] < 0:
                        out.number[reference] = uses
                        out.used[uses] = reference
                        uses += 1
                    out.place[count, k] = out.number[reference]
                count += 1
        out.within[j, 0], out.within[j, 1] = count, uses
    return max(known, steps)


@njit(cache=True, nogil=True)
def _lay_out_moment(
    space: SpaceTables, first: int, at: int, direction: int, on: bool, counted: bool, steps: int, out: Reach, moment: int
) -> None:  # fmt: skip
    """All states at one moment; without `on`, the next pose is the same; without `counted`, going on costs no time."""
    poses = space.spread.shape[0]
    early, late, runs = clock_span(first, at, direction, poses)
    pose = at % poses
    beside = (pose + direction) % poses if on else pose
    begin = pose if direction > 0 else beside
    count, corners = out.within[steps, 0], out.place.shape[1]
    for c in range(count):
        seconds = here = there = stride = pace = 0.0
        for k in range(corners):
            p, w = out.used[out.place[c, k]], out.weight[c, k]
            seconds += w * (space.clock[p, late] - space.clock[p, early] + runs * space.clock[p, poses])
            pace += w * (space.clock[p, begin + 1] - space.clock[p, begin])
            for other in range(corners):
                q, share = out.used[out.place[c, other]], w * out.weight[c, other]
                if other < k:
                    here += share * space.spread[pose, p, q]
                    there += share * space.spread[beside, p, q]
                stride += share * space.stride[begin, p, q]
        state = out.state[moment, c]
        state[_SECONDS], state[_VARIANCE], state[_BESIDE] = seconds, here, there
        state[_STRIDE], state[_PACE] = stride if on else 0.0, pace if on and counted else 0.0
    out.laid[moment] = count


@njit(cache=True, nogil=True)
def _cheapest(
    distance: np.ndarray, largest: float, i: int, p0: int, p1: int, uses: int, j: int, q0: int, q1: int, on: bool,
    back: bool, latency: float, threshold: float, best: float, found: Found,
) -> float:  # fmt: skip
    """The least cost from the states of two moments on, if it is below `best`; `found` then holds it.

    p0, p1: poses of the source, now and next, with the same `uses` references in use at both; q0, q1: of the target, then
    and before. on, back: whether the trellises go on to p1 and q1.
    """
    scale = SHAPE / largest
    source, target, part = found.source, found.target, found.part
    leaving, entering = source.state[i], target.state[j]
    corners, others = source.place.shape[1], target.place.shape[1]
    soonest = np.inf
    for s in range(source.laid[i]):
        soonest = min(soonest, leaving[s, _SECONDS])
    for t in range(target.laid[j]):
        if latency * (soonest + entering[t, _SECONDS]) >= best:
            continue
        for u in range(uses):
            r = source.used[u]
            d00 = d10 = d01 = d11 = 0.0
            for k in range(others):
                q, w = target.used[target.place[t, k]], target.weight[t, k]
                d00 += w * distance[p0, r, q0, q]
                d10 += w * distance[p1, r, q0, q]
                d01 += w * distance[p0, r, q1, q]
                d11 += w * distance[p1, r, q1, q]
            part[t, u, 0], part[t, u, 1], part[t, u, 2], part[t, u, 3] = d00, d10, d01, d11
    for s in range(source.laid[i]):
        v, vb = leaving[s, _VARIANCE], leaving[s, _BESIDE]
        fs, slow = scale * leaving[s, _STRIDE], latency * leaving[s, _PACE]
        for t in range(target.laid[j]):
            late = latency * (leaving[s, _SECONDS] + entering[t, _SECONDS])
            if late >= best:
                continue
            d00 = d10 = d01 = d11 = 0.0
            for k in range(corners):
                u, weight = source.place[s, k], source.weight[s, k]
                d00 += weight * part[t, u, 0]
                d10 += weight * part[t, u, 1]
                d01 += weight * part[t, u, 2]
                d11 += weight * part[t, u, 3]
            w, wb = entering[t, _VARIANCE], entering[t, _BESIDE]
            d00, d10, d01, d11 = d00 - v - w, d10 - (vb + w), d01 - (v + wb), d11 - (vb + wb)
            ft, slower = scale * entering[t, _STRIDE], latency * entering[t, _PACE]
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
                found.source_pose[0], found.target_pose[0] = p0 + a, q0 - b
                if found.source_pose[0] >= distance.shape[0]:
                    found.source_pose[0] -= distance.shape[0]
                if found.target_pose[0] < 0.0:
                    found.target_pose[0] += distance.shape[2]
                found.source_control[:] = source.control[s]
                found.target_control[:] = target.control[t]
                found.cost[0], found.cost[1] = shape, waits
                found.cost[2] = leaving[s, _SECONDS] + a * leaving[s, _PACE]
                found.cost[3] = entering[t, _SECONDS] + b * entering[t, _PACE]
    return best


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
