"""How far the limbs of a surface stand out from it."""

from __future__ import annotations

import numpy as np
from numba import njit
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

# Points spread over the surface, from which remoteness is measured: on a line its ends and what halves it four times.
_SAMPLES = 17


def limb_lengths(vertices: np.ndarray, faces: np.ndarray, count: int) -> np.ndarray:
    """The lengths (count,), m, of the limbs that stand out most, longest first; 0 where there are no more.

    vertices (V, 3) m, faces (F, 3), one piece. The remoteness of a vertex is the mean of its distances, along edges,
    to points spread over the surface: it is least in the middle of the body and greatest at the ends of its limbs. The
    length of a limb is the difference of remoteness between its end and where, going down from there, a more remote
    end comes into reach; that of the most remote end reaches down to the middle. Bending changes no distance along the
    surface, so a limb keeps its length in all poses; one that is joined to what it does not belong to is shorter,
    since remoteness falls from inside it to both sides, or no limb any more.
    Source: Hilaga, Shinagawa, Kohmura and Kunii 2001, SIGGRAPH, section 3 (remoteness); Edelsbrunner, Letscher and
    Zomorodian 2002, Discrete and Computational Geometry 28(4) (persistence of maxima).
    Departure: points spread by farthest point sampling stand for the whole surface.
    """
    graph = _edge_graph(np.asarray(vertices, np.float64), faces)
    remoteness = _remoteness(graph)
    order = np.argsort(-remoteness, kind="stable")
    found = np.sort(_persistence(remoteness, order, graph.indptr, graph.indices))[::-1]
    return np.pad(found, (0, max(count - len(found), 0)))[:count]


def _edge_graph(points: np.ndarray, faces: np.ndarray) -> csr_matrix:
    """The lengths of all edges, both ways."""
    ends = np.concatenate([faces, faces[:, [1, 2, 0]]], axis=1).reshape(len(faces), 2, 3)
    start, end = np.concatenate([ends, ends[:, ::-1]]).transpose(1, 0, 2).reshape(2, -1)
    graph = csr_matrix((np.ones(len(start)), (start, end)), shape=(len(points),) * 2)
    graph.sum_duplicates()
    away = points[np.repeat(np.arange(len(points)), np.diff(graph.indptr))] - points[graph.indices]
    # an edge of no length would be no edge
    graph.data = np.maximum(np.linalg.norm(away, axis=1), 1e-9)
    return graph


def _remoteness(graph: csr_matrix) -> np.ndarray:
    total = np.zeros(graph.shape[0])
    nearest = np.full(graph.shape[0], np.inf)
    at = int(_distance(graph, 0).argmax())
    for _ in range(_SAMPLES):
        distance = _distance(graph, at)
        total += distance
        nearest = np.minimum(nearest, distance)
        at = int(nearest.argmax())
    return total / _SAMPLES


def _distance(graph: csr_matrix, start: int) -> np.ndarray:
    distance = np.asarray(dijkstra(graph, indices=start))
    # loose vertices belong to no limb
    distance[np.isinf(distance)] = 0
    return distance


@njit(cache=True, nogil=True)
def _persistence(
    height: np.ndarray, order: np.ndarray, start: np.ndarray, neighbour: np.ndarray
) -> np.ndarray:
    """Per vertex, how far below it its peak is joined to a higher one; 0 where there is no peak.

    order: vertices from high to low; neighbours of i are neighbour[start[i] : start[i + 1]].
    """
    count = len(height)
    rank = np.empty(count, np.int64)
    for k in range(count):
        rank[order[k]] = k
    # vertices that are above and joined lead up to one peak
    up = np.full(count, -1, np.int64)
    found = np.zeros(count)
    for i in order:
        up[i] = i
        for s in range(start[i], start[i + 1]):
            peak = neighbour[s]
            if up[peak] < 0:
                continue
            peak, own = _peak(up, peak), _peak(up, i)
            if peak == own:
                continue
            if rank[peak] > rank[own]:
                peak, own = own, peak
            up[own] = peak
            found[own] = height[own] - height[i]
    found[order[0]] = height[order[0]] - height[order[-1]]
    return found


@njit(cache=True, nogil=True)
def _peak(up: np.ndarray, i: int) -> int:
    while up[i] != i:
        up[i] = up[up[i]]
        i = up[i]
    return i
