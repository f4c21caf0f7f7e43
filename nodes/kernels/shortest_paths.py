"""Shortest paths between all nodes of a dense digraph, and the edges that they need."""

from __future__ import annotations

import numpy as np
import scipy.sparse
from numba import njit
from scipy.sparse.csgraph import dijkstra

_BLOCK = 64
# relative difference of costs that counts as a tie: what rounding makes of equal sums
_TIE = 1e-9


def all_distances(cost: np.ndarray) -> np.ndarray:
    """The cost of the best path from every node to every other, (N, N) float64; 0 from a node to itself.

    cost (N, N): of the edge from row to column, above 0, inf where there is none; the diagonal is not read.
    Floyd and Warshall's recursion in blocks that stay in the cache.

    Source: Venkataraman, Sahni and Mukhopadhyaya 2003, ACM JEA (blocks).
    """
    distance = np.array(cost, np.float64, order="C")
    np.fill_diagonal(distance, 0.0)
    _close(distance)
    return distance


@njit(cache=True, nogil=True)
def essential_edges(cost: np.ndarray, distance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sources and targets of the edges that alone keep all distances: no path over other nodes is as cheap.

    cost, distance (N, N) float64 as in and from `all_distances`. Since costs are above 0, the kept edges have the
    same distances between all nodes, and no smaller set has.
    """
    count = len(cost)
    back = distance.T.copy()
    source, target = [0 for _ in range(0)], [0 for _ in range(0)]
    for i in range(count):
        for j in range(count):
            bound = distance[i, j] * (1.0 + _TIE)
            if i == j or not cost[i, j] <= bound:
                continue
            needed = True
            # captured successors first: they replace most edges
            for step in range(1, count):
                k = (i + step) % count
                if k != j and distance[i, k] + back[j, k] <= bound:
                    needed = False
                    break
            if needed:
                source.append(i)
                target.append(j)
    return np.array(source, np.int32), np.array(target, np.int32)


def sparse_paths(
    count: int, source: np.ndarray, target: np.ndarray, cost: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Distances (N, N) float64 (inf: no path) and predecessors (N, N) int32 (-1: none) over given edges."""
    graph = scipy.sparse.csr_matrix((cost, (source, target)), shape=(count, count))
    distance, before = dijkstra(graph, return_predecessors=True)
    return distance, np.where(before < 0, -1, before).astype(np.int32)


def shortest_path(predecessor: np.ndarray, start: int, end: int) -> list[int]:
    """The nodes of the best path from start to end, both included; empty where there is none."""
    path = [end]
    while path[-1] != start:
        before = int(predecessor[start, path[-1]])
        if before < 0:
            return []
        path.append(before)
    return path[::-1]


@njit(cache=True, nogil=True)
def _close(d: np.ndarray) -> None:
    count = len(d)
    blocks = (count + _BLOCK - 1) // _BLOCK
    for b in range(blocks):
        _relax(d, b, b, b)
        for c in range(blocks):
            if c != b:
                _relax(d, b, c, b)
                _relax(d, c, b, b)
        for r in range(blocks):
            if r != b:
                for c in range(blocks):
                    if c != b:
                        _relax(d, r, c, b)


@njit(cache=True, nogil=True)
def _relax(d: np.ndarray, row: int, column: int, over: int) -> None:
    """Paths between the nodes of two blocks over the nodes of a third."""
    count = len(d)
    left, right = column * _BLOCK, min((column + 1) * _BLOCK, count)
    for k in range(over * _BLOCK, min((over + 1) * _BLOCK, count)):
        via = d[k, left:right]
        for i in range(row * _BLOCK, min((row + 1) * _BLOCK, count)):
            first = d[i, k]
            out = d[i, left:right]
            for j in range(right - left):
                total = first + via[j]
                out[j] = total if total < out[j] else out[j]
