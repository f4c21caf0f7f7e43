"""Transitions chosen once and for all: the baseline of the search at run time."""

from __future__ import annotations

import numpy as np
from numba import njit

from reperform.nodes.kernels.transition_search import RATE, SHAPE
from reperform.nodes.kernels.transition_tables import EdgeTables, SpaceTables


def choose_fixed(
    distance: np.ndarray, count: int, apart: int, leave: int = 0, enter: int | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """The `count` pairs of least distance (Ks, Rs, Kt, Rt), best first: poses (n, 2), references (n, 2).

    Two of them are at least `apart` poses from each other in the source or in the target. leave: first pose at which
    the source is left; enter: last pose at which the target is entered (default: any).
    """
    length, _, other_length, other_references = distance.shape
    rows = distance.transpose(0, 2, 1, 3).reshape(length, other_length, -1)
    least, which = rows.min(axis=2), rows.argmin(axis=2)
    least[:leave] = np.inf
    least[:, other_length if enter is None else enter + 1 :] = np.inf
    poses: list[tuple[int, int]] = []
    for flat in np.argsort(least, axis=None, kind="stable").tolist():
        m, n = divmod(flat, other_length)
        if np.isfinite(least[m, n]) and all(abs(m - p) >= apart or abs(n - q) >= apart for p, q in poses):
            poses.append((m, n))
            if len(poses) == count:
                break
    chosen = np.array(poses, np.int32).reshape(-1, 2)
    return chosen, np.stack(np.divmod(which[chosen[:, 0], chosen[:, 1]], other_references), axis=1).astype(
        np.int32
    )


@njit(cache=True, nogil=True)
def fixed_transition(
    tables: EdgeTables, pose: np.ndarray, reference: np.ndarray, cost: np.ndarray, source_pose: int,
    source_control: np.ndarray, target_pose: int, target_control: np.ndarray, step: float, latency_weight: float,
    out: np.ndarray,
) -> bool:  # fmt: skip
    """The cheapest of fixed transitions (n, 2) from a state to a state: out = E_S, lambda E_L, seconds before, after.

    The character plays on until its pose and, changing a control by `step` of its range in every `step` of the run,
    its controls are those of the transition; after it the same towards the wanted state. False where none can be
    used, since a motion that is not cyclic has gone past it.
    """
    best = np.inf
    for k in range(len(pose)):
        before = _way(tables.source, source_pose, source_control, pose[k, 0], reference[k, 0], step, False)
        after = _way(tables.target, target_pose, target_control, pose[k, 1], reference[k, 1], step, True)
        latency = latency_weight * RATE * (before + after)
        if SHAPE * cost[k] + latency < best:
            best = SHAPE * cost[k] + latency
            out[0], out[1], out[2], out[3] = SHAPE * cost[k], latency, before, after
    return best < np.inf


@njit(cache=True, nogil=True)
def _way(
    space: SpaceTables,
    pose: int,
    control: np.ndarray,
    goal: int,
    reference: int,
    step: float,
    backwards: bool,
) -> float:
    """Seconds from a state to a fixed one (backwards: from the fixed one to the state); inf where it cannot be."""
    poses = space.spread.shape[0]
    change = 0.0
    for axis in range(len(control)):
        change = max(change, abs(space.control[reference, axis] - control[axis]))
    least = int(np.ceil(change / step - 1e-9) * step * poses)
    first, last = (goal, pose) if backwards else (pose, goal)
    if not space.cyclic:
        if last - first < least:
            return np.inf
        return space.clock[reference, last] - space.clock[reference, first]
    gap = (last - first) % poses
    runs = 0
    while gap + runs * poses < least:
        runs += 1
    clock = space.clock[reference]
    return clock[first + gap] - clock[first] + runs * clock[poses]
