"""Minimum spanning tree of a dense graph, and the best node to hang it from."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def minimum_spanning_tree(distance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Prim's algorithm on a symmetric matrix (n, n), from node 0: parents (n,) and the order of joining (n,).

    O(n^2) time, O(n) memory besides the matrix. Ties go to the lower index. Node 0 is its own parent.
    """
    n = len(distance)
    parent = np.zeros(n, np.int32)
    order = np.zeros(n, np.int32)
    joined = np.zeros(n, np.bool_)
    nearest = distance[0].copy()
    joined[0] = True
    for k in range(1, n):
        best = -1
        for i in range(n):
            if not joined[i] and (best < 0 or nearest[i] < nearest[best]):
                best = i
        joined[best] = True
        order[k] = best
        for i in range(n):
            if not joined[i] and distance[best, i] < nearest[i]:
                nearest[i] = distance[best, i]
                parent[i] = best
    return parent, order


@njit(cache=True, nogil=True)
def path_cost_sums(parent: np.ndarray, order: np.ndarray, length: np.ndarray) -> np.ndarray:
    """Sum of the path lengths from every node of a tree to all others (n,); `length` is the edge to the
    parent."""
    n = len(parent)
    below = np.ones(n)
    sums = np.zeros(n)
    for k in range(n - 1, 0, -1):
        i = order[k]
        below[parent[i]] += below[i]
        sums[order[0]] += below[i] * length[i]
    for k in range(1, n):
        i = order[k]
        sums[i] = sums[parent[i]] + (n - 2 * below[i]) * length[i]
    return sums


def rehang(parent: np.ndarray, root: int) -> tuple[np.ndarray, np.ndarray]:
    """The same tree hung from another node: parents (n,) with parent[root] = root, and an order (n,),
    breadth first.

    Children come in ascending order.
    """
    n = len(parent)
    neighbours: list[list[int]] = [[] for _ in range(n)]
    for i, p in enumerate(parent):
        if p != i:
            neighbours[i].append(int(p))
            neighbours[p].append(i)
    turned = np.full(n, -1, np.int32)
    turned[root] = root
    order = [root]
    for i in order:
        for child in sorted(neighbours[i]):
            if turned[child] < 0:
                turned[child] = i
                order.append(child)
    return turned, np.array(order, np.int32)
