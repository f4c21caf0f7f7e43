"""Deformation graphs: a few nodes on a surface whose rigid motions move all of it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import dijkstra, reverse_cuthill_mckee

from reperform.nodes.kernels.mesh_geometry import edges

INFLUENCES = 4
# Distance (m) that stands for "on another part of the surface".
_APART = 1e3


class DeformationGraph(NamedTuple):
    """Nodes on a mesh: vertex i moves as x_i = sum_k weight[i, k] (R_j (p_i - g_j) + g_j + t_j), j =
    influence[i, k].

    Nodes come in an order of small bandwidth, so that the normal equations are banded.
    """

    places: np.ndarray  # (K, 3) float64, the nodes' rest positions g, m
    samples: np.ndarray  # (K,) int32, the vertices that the nodes are
    influence: np.ndarray  # (V, 4) int32
    weight: np.ndarray  # (V, 4) float64, rows sum to 1
    links: np.ndarray  # (E, 2) int32, pairs of nodes that move a vertex together
    bandwidth: int  # largest difference of linked nodes


def farthest_samples(vertices: np.ndarray, faces: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (count,) spread evenly by farthest point sampling, and their distances along edges (count, V).

    Each sample is the vertex farthest along the surface from those before, so any leading part of them is
    itself evenly spread. The first one is the vertex farthest from the mean. Source: Eldar et al., IEEE TIP
    1997.
    """
    pairs = edges(faces)
    lengths = np.linalg.norm(vertices[pairs[:, 0]] - vertices[pairs[:, 1]], axis=1)
    graph = scipy.sparse.coo_matrix(
        (np.maximum(lengths, 1e-9), (pairs[:, 0], pairs[:, 1])), shape=(len(vertices), len(vertices))
    ).tocsr()
    count = min(count, len(vertices))
    samples = np.empty(count, np.int32)
    distances = np.empty((count, len(vertices)))
    nearest = np.linalg.norm(vertices - vertices.mean(axis=0), axis=1)
    for k in range(count):
        samples[k] = np.argmax(nearest)
        found = dijkstra(graph, directed=False, indices=samples[k])
        distances[k] = np.minimum(found, _APART)
        nearest = distances[k].copy() if k == 0 else np.minimum(nearest, distances[k])
    return samples, distances


def deformation_graph(
    vertices: np.ndarray, samples: np.ndarray, distances: np.ndarray, count: int
) -> DeformationGraph:
    """The graph of the first `count` samples (`farthest_samples`) of a mesh with `vertices` (V, 3).

    Each vertex follows its four nearest nodes along the surface with weights (1 - d / d_5)^2, d_5 the
    distance of the fifth; so parts that touch without being connected do not move each other.
    Source: Sumner, Schmid and Pauly, SIGGRAPH 2007; geodesic distances: Li, Sumner and Pauly, SGP 2008.
    """
    count = min(count, len(samples))
    distance = distances[:count]
    order = np.argsort(distance, axis=0, kind="stable")[: INFLUENCES + 1].T
    if order.shape[1] < INFLUENCES + 1:
        order = np.pad(order, ((0, 0), (0, INFLUENCES + 1 - order.shape[1])), mode="edge")
    sorted_distance = np.take_along_axis(distance.T, order, axis=1)
    limit = sorted_distance[:, -1:] * (1 + 1e-6) + 1e-9
    weight = np.maximum(1 - sorted_distance[:, :INFLUENCES] / limit, 0) ** 2
    weight[:, min(count, INFLUENCES) :] = 0
    weight[:, 0] = np.maximum(weight[:, 0], 1e-6)
    influence = order[:, :INFLUENCES]
    position, links, bandwidth = _band_order(influence, weight, count)
    chosen = np.empty(count, np.int32)
    chosen[position] = samples[:count]
    return DeformationGraph(
        np.asarray(vertices[chosen], np.float64),
        chosen,
        position[influence].astype(np.int32),
        weight / weight.sum(axis=1, keepdims=True),
        links,
        bandwidth,
    )


def carried(graph: DeformationGraph, vertices: np.ndarray) -> DeformationGraph:
    """The same graph resting on another pose (V, 3) of its mesh."""
    return graph._replace(places=np.asarray(vertices[graph.samples], np.float64))


def _band_order(influence: np.ndarray, weight: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray, int]:
    first, second = np.triu_indices(INFLUENCES, 1)
    i, j = influence[:, first].ravel(), influence[:, second].ravel()
    used = (weight[:, first] * weight[:, second]).ravel() > 0
    used &= i != j
    graph = scipy.sparse.coo_matrix(
        (np.ones(2 * used.sum()), (np.r_[i[used], j[used]], np.r_[j[used], i[used]])), shape=(count, count)
    ).tocsr()
    position = np.empty(count, np.int64)
    position[reverse_cuthill_mckee(graph, symmetric_mode=True)] = np.arange(count)
    rows, columns = graph.nonzero()
    links = np.unique(np.sort(np.stack([position[rows], position[columns]], axis=1), axis=1), axis=0)
    width = int((links[:, 1] - links[:, 0]).max()) if len(links) else 0
    return position, links.reshape(-1, 2).astype(np.int32), width
