"""Walks between key frames as integer programmes: a walk without loops, and how often loops are attached."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from time import perf_counter
from typing import NamedTuple

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp

from reperform.nodes.kernels.walk_moves import Moves, Targets, Walk, least_steps

# Solutions that fall apart, cut off one after the other, at most.
_CUTS = 1000
# How often a loop is taken at most where no target says so.
_OFTEN = 1000.0


class Pieces(NamedTuple):
    """All loop-free walks from the start to the end and all loops, each as moves in order."""

    walks: list[tuple[int, ...]]
    loops: list[tuple[int, ...]]


def enumerate_pieces(moves: Moves, horizon: int, walks: int, loops: int) -> Pieces:
    """Every loop-free walk and every loop of at most `horizon` steps that meets no state twice.

    Raises ValueError where there are more than `walks` or `loops` of them.
    """
    found = _walks(moves, horizon, walks, least_steps(moves))
    reached = {state for walk in found for state in _states(moves, walk)}
    # a loop may hang on another loop, so all that the walks lead to counts
    reached |= _beyond(moves, reached)
    return Pieces(found, _loops(moves, horizon, loops, reached))


def solve_programme(moves: Moves, pieces: Pieces, targets: Targets, seconds: float = np.inf) -> Walk | None:
    """The cheapest walk within the tolerances; None where there is none.

        minimise  c . n + distance_weight |d . n - d_V| + steps_weight |t . n - t_V|,   n_0 = 1, n_i = 0, 1, 2, ...

    for every loop-free walk (piece 0) with all loops, costs c, lengths d, steps t; the absolute values by two slack
    variables, bounded by the tolerances. Loops that hang on nothing are cut off: every loop of a set S that meets neither
    the walk nor itself elsewhere needs one outside that meets S. The pieces are strung to one walk (Hierholzer).

    Raises TimeoutError where that takes longer than `seconds`.

    Source: Huang, Tejera, Collomosse and Hilton 2015, ACM TOG (000 eqs 14-25).
    Departure: targets are subtracted once, not once per loop (eq 24), and loops must connect to the walk.
    """
    columns = np.array([_sums(moves, loop) for loop in pieces.loops]).reshape(-1, 3)
    states = [_states(moves, loop) for loop in pieces.loops]
    best: tuple[float, list[int]] | None = None
    until = perf_counter() + seconds
    for walk in sorted(pieces.walks, key=lambda walk: float(_sums(moves, walk)[0])):
        own = _sums(moves, walk)
        if best is not None and own[0] >= best[0]:
            break
        under = np.inf if best is None else best[0]
        found = _repetitions(own, columns, states, _states(moves, walk), targets, under, until)
        if found is not None and (best is None or found[0] < best[0]):
            best = found[0], _strung(moves, walk, pieces.loops, found[1])
    if best is None:
        return None
    cost, distance, steps = _sums(moves, best[1])
    taken = moves.passage[np.array(best[1])]
    total = float(cost + targets.miss(distance, steps))
    return Walk(tuple(taken[taken >= 0].tolist()), float(distance), int(steps), total, total)


def _repetitions(
    walk: np.ndarray,
    loops: np.ndarray,
    states: Sequence[set[int]],
    seen: set[int],
    targets: Targets,
    under: float,
    until: float,
) -> tuple[float, np.ndarray] | None:
    """Total cost and how often each loop is taken, for one loop-free walk; None where nothing under `under`."""
    count = len(loops)
    objective = np.concatenate([loops[:, 0], [targets.distance_weight, targets.steps_weight]])
    rows, upper, most, limits = _misses(walk, loops, targets)
    bounds = Bounds(np.zeros(count + 2), np.concatenate([most, limits]))
    whole = np.concatenate([np.ones(count), np.zeros(2)])
    for _ in range(_CUTS):
        constraints = LinearConstraint(np.array(rows), -np.inf, np.array(upper)) if rows else ()
        left = until - perf_counter()
        if left <= 0:
            raise TimeoutError("key frames: the integer programmes took longer than allowed")
        options = {"mip_rel_gap": 0.0} | ({"time_limit": left} if np.isfinite(left) else {})
        solved = milp(objective, integrality=whole, bounds=bounds, constraints=constraints, options=options)
        if solved.status == 1:
            raise TimeoutError("key frames: the integer programmes took longer than allowed")
        if solved.x is None or solved.fun + walk[0] >= under:
            return None
        times = np.rint(solved.x[:count]).astype(int)
        apart = _unconnected(times, states, seen)
        if not apart:
            exact = walk + times @ loops
            return float(exact[0] + targets.miss(exact[1], exact[2])), times
        touched = set().union(*(states[k] for k in apart))
        bridges = [k for k in range(count) if k not in apart and states[k] & touched]
        for k in apart:
            row = np.zeros(count + 2)
            row[k], row[bridges] = 1.0, -most[k]
            rows.append(row)
            upper.append(0.0)
    raise ValueError(f"key frames: loops did not connect after {_CUTS} cuts: use the dynamic program")


def _misses(
    walk: np.ndarray, loops: np.ndarray, targets: Targets
) -> tuple[list[np.ndarray], list[float], np.ndarray, list[float]]:
    """Rows and right sides of |walk + n . loops - target| <= slack, the most of each loop, limits of both slacks."""
    rows, upper, limits = [], [], []
    most = np.full(len(loops), _OFTEN)
    asked = (targets.distance, targets.steps)
    for k, (wanted, tolerance) in enumerate(zip(asked, targets[4:], strict=True)):
        limits.append(np.inf if np.isnan(wanted) else tolerance)
        if np.isnan(wanted):
            continue
        room = wanted - walk[k + 1]
        for sign in (1.0, -1.0):
            rows.append(np.concatenate([sign * loops[:, k + 1], -np.eye(2)[k]]))
            upper.append(sign * room)
        most = np.minimum(most, max(room + tolerance, 0.0) / np.maximum(loops[:, k + 1], 1e-9))
    return rows, upper, np.floor(most + 1e-9), limits


def _unconnected(times: np.ndarray, states: Sequence[set[int]], seen: set[int]) -> set[int]:
    """The loops taken that do not hang on the walk, directly or through others."""
    seen, left = set(seen), set(np.flatnonzero(times).tolist())
    while joined := {k for k in left if states[k] & seen}:
        left -= joined
        seen = seen.union(*(states[k] for k in joined))
    return left


def _strung(
    moves: Moves, walk: Sequence[int], loops: Sequence[Sequence[int]], times: np.ndarray
) -> list[int]:
    """One walk over all moves of the pieces: each loop is let in where its first known state is met."""
    out = list(walk)
    left = {k: int(times[k]) for k in np.flatnonzero(times).tolist()}
    origin = moves.origin
    while left:
        for k in list(left):
            at = {int(origin[e]): i for i, e in enumerate(out)}
            turn = next((i for i, e in enumerate(loops[k]) if int(origin[e]) in at), None)
            if turn is not None:
                place = at[int(origin[loops[k][turn]])]
                out[place:place] = (list(loops[k][turn:]) + list(loops[k][:turn])) * left.pop(k)
    return out


def _sums(moves: Moves, edges: Sequence[int]) -> np.ndarray:
    """Cost, length and steps of moves."""
    chosen = np.array(edges)
    return np.array(
        [column[chosen].astype(np.float64).sum() for column in (moves.cost, moves.length, moves.steps)]
    )


def _states(moves: Moves, edges: Sequence[int]) -> set[int]:
    return {int(np.searchsorted(moves.first, e, side="right")) - 1 for e in edges}


def _walks(moves: Moves, horizon: int, limit: int, quickest: np.ndarray) -> list[tuple[int, ...]]:
    found: list[tuple[int, ...]] = []
    pending: list[tuple[int, int, tuple[int, ...], frozenset[int]]] = [(0, 0, (), frozenset([0]))]
    while pending:
        state, steps, edges, met = pending.pop()
        for e in range(int(moves.first[state]), int(moves.first[state + 1])):
            after, far = int(moves.following[e]), steps + int(moves.steps[e])
            if after < 0 and far <= horizon:
                found.append((*edges, e))
            elif after >= 0 and after not in met and far + quickest[after] <= horizon:
                pending.append((after, far, (*edges, e), met | {after}))
        if len(found) > limit:
            raise ValueError(
                f"key frames: more than {limit} loop-free walks: keep fewer transitions or raise walks"
            )
    return found


def _beyond(moves: Moves, states: set[int]) -> set[int]:
    """All states that can be reached from some."""
    seen, pending = set(states), list(states)
    while pending:
        state = pending.pop()
        for after in moves.following[moves.first[state] : moves.first[state + 1]].tolist():
            if after >= 0 and after not in seen:
                seen.add(after)
                pending.append(after)
    return seen


def _loops(moves: Moves, horizon: int, limit: int, states: set[int]) -> list[tuple[int, ...]]:
    """Each loop once, from the least of its states."""
    found: list[tuple[int, ...]] = []
    back: dict[int, set[int]] = defaultdict(set)
    for e, state in enumerate(moves.origin.tolist()):
        back[int(moves.following[e])].add(state)
    for root in sorted(states):
        home = _leading_to(root, back)
        pending: list[tuple[int, int, tuple[int, ...], frozenset[int]]] = [(root, 0, (), frozenset([root]))]
        while pending:
            state, steps, edges, met = pending.pop()
            for e in range(int(moves.first[state]), int(moves.first[state + 1])):
                after, far = int(moves.following[e]), steps + int(moves.steps[e])
                if after == root and far <= horizon:
                    found.append((*edges, e))
                elif after > root and after in home and after not in met and far < horizon:
                    pending.append((after, far, (*edges, e), met | {after}))
            if len(found) > limit:
                raise ValueError(
                    f"key frames: more than {limit} loops: keep fewer transitions or raise loops"
                )
    return found


def _leading_to(root: int, back: dict[int, set[int]]) -> set[int]:
    """The states, none below the root, from which it can be reached."""
    seen, pending = {root}, [root]
    while pending:
        for before in back[pending.pop()]:
            if before > root and before not in seen:
                seen.add(before)
                pending.append(before)
    return seen
