"""The cheapest walk along a curve by depth-first search with branch and bound."""

from __future__ import annotations

import numpy as np
from numba import njit

from reperform.nodes.kernels.curve_reach import distance_left
from reperform.nodes.kernels.curve_walk import REST_STEP, CurveWalk, Starts, Trail, first_states, follow


def depth_first_walk(
    trail: Trail,
    rest: np.ndarray | None,
    starts: Starts,
    expansions: int,
    *,
    reach: np.ndarray | None = None,
    below: float = np.inf,
    enough: float = -np.inf,
) -> tuple[CurveWalk | None, bool]:
    """The best walk that depth-first search finds, and whether it has been through all of them.

    Moves are tried cheapest first; a branch ends where its cost, with `rest` its cost and the least that remains,
    with `reach` (curve_reach) also the least distance, reaches that of the best walk so far. expansions: moves tried
    at most; below: only walks that cost less are looked for, so that none found by the end proves that there is none;
    enough: a walk of at most this cost ends the search.

    Source: Boukhayma and Boyer 2015, 3DV (002 section 4: depth-first search with branch and bound).
    """
    chain, start, cost, tried, done = _search(
        trail,
        np.zeros((1, 1)) if rest is None else rest,
        np.zeros((1, 1)) if reach is None else reach,
        (rest is not None, reach is not None),
        starts.frame.astype(np.int64),
        first_states(starts),
        expansions,
        float(below),
        float(enough),
    )
    if start < 0:
        return None, bool(done)
    return CurveWalk(tuple(chain.tolist()), int(start), float(cost), int(tried)), bool(done)


@njit(cache=True, nogil=True)
def _search(
    trail: Trail,
    rest: np.ndarray,
    reach: np.ndarray,
    use: tuple[bool, bool],
    frames: np.ndarray,
    states: np.ndarray,
    expansions: int,
    least: float,
    enough: float,
) -> tuple[np.ndarray, int, float, int, bool]:
    # every frame played on without getting anywhere still costs, so the depth is bounded by the best cost
    deepest = 20_000
    widest = 0
    for i in range(len(trail.leaving) - 1):
        widest = max(widest, trail.leaving[i + 1] - trail.leaving[i])
    # of each depth: the moves allowed there, where they lead, and their order by cost
    moves, outs = np.empty((deepest + 1, widest), np.int32), np.empty((deepest + 1, widest, 7))
    order = np.empty((deepest + 1, widest), np.int32)
    turn, width = np.zeros(deepest + 1, np.int64), np.zeros(deepest + 1, np.int64)
    chain, start, tried = np.empty(0, np.int32), -1, 0
    taken = np.empty(deepest + 1, np.int32)
    for k in range(len(frames)):
        node, here = frames[k], states[k]
        depth, turn[0], width[0] = 0, 0, -1
        while depth >= 0:
            if tried >= expansions:
                return chain, start, least, tried, False
            if width[depth] < 0:
                wide = 0
                for e in range(trail.leaving[node], trail.leaving[node + 1]):
                    tried += 1
                    if follow(trail, e, here, outs[depth, wide]):
                        moves[depth, wide] = e
                        wide += 1
                width[depth], turn[depth] = wide, 0
                order[depth, :wide] = np.argsort(outs[depth, :wide, 6], kind="mergesort")
            if turn[depth] == width[depth] or depth == deepest:
                depth -= 1
                continue
            place = order[depth, turn[depth]]
            turn[depth] += 1
            e, out = moves[depth, place], outs[depth, place]
            to, arrived, bound = trail.target[e], out[3] >= trail.length, out[6]
            if use[0] and not arrived:
                bound += rest[min(int(out[3] / REST_STEP), rest.shape[0] - 1), to]
            if use[1] and not arrived and bound < least:
                bound += trail.distance_weight * distance_left(
                    trail.points, trail.step, trail.length, reach[to], out[3], out[4], out[5]
                )
            if bound >= least:
                continue
            taken[depth] = e
            if arrived:
                least, start = out[6], k
                chain = taken[: depth + 1].copy()
                if least <= enough:
                    return chain, start, least, tried, False
                continue
            depth += 1
            node, here = to, out
            width[depth] = -1
    return chain, start, least, tried, True
