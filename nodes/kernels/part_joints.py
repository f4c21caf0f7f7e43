"""Joints of a surface whose parts are marked: a fixed linear map of its vertices, and the tree of its parts."""

from __future__ import annotations

from collections import deque

import numpy as np
import scipy.sparse

from reperform.nodes.kernels.mesh_geometry import edges


def part_tree(label: np.ndarray, faces: np.ndarray, parts: int, root: int) -> tuple[np.ndarray, np.ndarray]:
    """(order, parent): parts from the root outwards, and the part each hangs on; -1 for the root.

    Parts are neighbours where an edge joins them; each is met first from the neighbour with the fewest parts to the
    root and, among those, the most joining edges. What hangs on nothing (hair under a hat) is left out of `order`.
    """
    ends = label[edges(faces)]
    ends = ends[(ends >= 0).all(axis=1) & (ends[:, 0] != ends[:, 1])]
    joined = np.zeros((parts, parts), int)
    np.add.at(joined, (ends[:, 0], ends[:, 1]), 1)
    joined += joined.T
    parent, depth = np.full(parts, -1), np.full(parts, -1)
    depth[root] = 0
    order, waiting = [], deque([root])
    while waiting:
        here = waiting.popleft()
        order.append(here)
        for other in np.flatnonzero(joined[here]):
            if depth[other] < 0:
                depth[other] = depth[here] + 1
                waiting.append(int(other))
            if depth[other] == depth[here] + 1 and (
                parent[other] < 0 or joined[here, other] > joined[parent[other], other]
            ):
                parent[other] = here
    return np.array(order), parent


def centre_map(label: np.ndarray, parts: int, areas: np.ndarray) -> scipy.sparse.csr_matrix:
    """(parts, V): centres of labelled vertex sets, vertices by the area around them; rows sum to 1."""
    inside = np.flatnonzero(label >= 0)
    weight = scipy.sparse.csr_matrix((areas[inside], (label[inside], inside)), shape=(parts, len(label)))
    return _rows_to_one(weight)


def ring_map(label: np.ndarray, faces: np.ndarray, parent: np.ndarray) -> scipy.sparse.csr_matrix:
    """(parts, V): centres of the rings where parts meet the part they hang on; empty rows elsewhere.

    A ring is made of the middles of the edges that join two parts, each by its share of the ring's vertices.
    """
    ends = edges(faces)
    one, other = label[ends[:, 0]], label[ends[:, 1]]
    rows, columns = [], []
    for part, up in enumerate(parent):
        if up >= 0:
            across = ends[((one == part) & (other == up)) | ((one == up) & (other == part))]
            corners = np.unique(across)
            rows.append(np.full(len(corners), part))
            columns.append(corners)
    row, column = np.concatenate(rows), np.concatenate(columns)
    return _rows_to_one(
        scipy.sparse.csr_matrix((np.ones(len(row)), (row, column)), shape=(len(parent), len(label)))
    )


def _rows_to_one(weight: scipy.sparse.csr_matrix) -> scipy.sparse.csr_matrix:
    total = np.asarray(weight.sum(axis=1)).ravel()
    return scipy.sparse.diags(1.0 / np.where(total > 0, total, 1.0)) @ weight
