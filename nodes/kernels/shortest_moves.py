"""The cheapest chain of moves between two frames."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from reperform.nodes.kernels.graph_moves import Moves

# A move that costs nothing still is a move, and sparse matrices know no edge of weight 0.
_LEAST = 1e-12


def shortest_moves(moves: Moves, source: int, target: int) -> list[int] | None:
    """Moves of least cost from frame to frame (Dijkstra); empty where they are one; None where there is no way."""
    if source == target:
        return []
    count = len(moves.leaving) - 1
    order = np.lexsort((moves.cost, moves.target, moves.source))
    first = np.ones(len(order), bool)
    first[1:] = (np.diff(moves.source[order]) != 0) | (np.diff(moves.target[order]) != 0)
    best = order[first]
    cost = np.maximum(moves.cost[best], _LEAST)
    matrix = csr_matrix((cost, (moves.source[best], moves.target[best])), shape=(count, count))
    _, before = dijkstra(matrix, indices=source, return_predecessors=True)
    if before[target] < 0:
        return None
    by_ends = {(int(moves.source[e]), int(moves.target[e])): int(e) for e in best}
    chain: list[int] = []
    while target != source:
        chain.append(by_ends[int(before[target]), target])
        target = int(before[target])
    return chain[::-1]
