"""The cheapest walk along a curve by depth-first search with branch and bound."""

from __future__ import annotations

import numpy as np
from numba import njit

from reperform.nodes.kernels.curve_walk import REST_STEP, CurveWalk, Starts, Trail, first_states, follow


def depth_first_walk(
    trail: Trail, rest: np.ndarray | None, starts: Starts, expansions: int
) -> tuple[CurveWalk | None, bool]:
    """The best walk that depth-first search finds, and whether it has been through all of them.

    Moves are tried cheapest first; a branch ends where its cost, with `rest` its cost and the least that remains,
    reaches that of the best walk so far. expansions: moves tried at most.

    Source: Boukhayma and Boyer 2015, 3DV (002 section 4: depth-first search with branch and bound).
    """
    use = rest is not None
    table = rest if rest is not None else np.zeros((1, 1))
    chain, start, cost, tried, done = _search(
        trail, table, use, starts.frame.astype(np.int64), first_states(starts), expansions
    )
    if start < 0:
        return None, bool(done)
    return CurveWalk(tuple(chain.tolist()), int(start), float(cost), int(tried)), bool(done)


@njit(cache=True, nogil=True)
def _search(
    trail: Trail, rest: np.ndarray, use: bool, frames: np.ndarray, states: np.ndarray, expansions: int
) -> tuple[np.ndarray, int, float, int, bool]:
    # every frame played on without getting anywhere still costs, so the depth is bounded by the best cost
    deepest = 20_000
    widest = 0
    for i in range(len(trail.leaving) - 1):
        widest = max(widest, trail.leaving[i + 1] - trail.leaving[i])
    state = np.empty((deepest + 1, 7))
    node = np.empty(deepest + 1, np.int64)
    order = np.empty((deepest + 1, widest), np.int32)
    turn, width = np.zeros(deepest + 1, np.int64), np.zeros(deepest + 1, np.int64)
    gain, outs = np.empty(widest), np.empty((widest, 7))
    chain, start, least, tried = np.empty(0, np.int32), -1, np.inf, 0
    taken = np.empty(deepest + 1, np.int32)
    out = np.empty(7)
    for k in range(len(frames)):
        node[0], state[0] = frames[k], states[k]
        depth, turn[0], width[0] = 0, 0, -1
        while depth >= 0:
            if tried >= expansions:
                return chain, start, least, tried, False
            if width[depth] < 0:
                width[depth], turn[depth] = 0, 0
                for e in range(trail.leaving[node[depth]], trail.leaving[node[depth] + 1]):
                    tried += 1
                    if follow(trail, e, state[depth], outs[width[depth]]):
                        order[depth, width[depth]] = e
                        gain[width[depth]] = outs[width[depth], 6]
                        width[depth] += 1
                ranks = np.argsort(gain[: width[depth]], kind="mergesort")
                order[depth, : width[depth]] = order[depth, : width[depth]][ranks]
            if turn[depth] == width[depth] or depth == deepest:
                depth -= 1
                continue
            e = order[depth, turn[depth]]
            turn[depth] += 1
            follow(trail, e, state[depth], out)
            bound = out[6]
            if use and out[3] < trail.length:
                bound += rest[min(int(out[3] / REST_STEP), rest.shape[0] - 1), trail.target[e]]
            if bound >= least:
                continue
            taken[depth] = e
            if out[3] >= trail.length:
                least, start = out[6], k
                chain = taken[: depth + 1].copy()
                continue
            depth += 1
            node[depth], state[depth] = trail.target[e], out
            width[depth] = -1
    return chain, start, least, tried, True
