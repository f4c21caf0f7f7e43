"""Folds of a mesh smoothed away, the rest of it left alone."""

from __future__ import annotations

import numpy as np
import scipy.sparse

from reperform.nodes.kernels.mesh_geometry import face_normals


def unfold(
    vertices: np.ndarray,
    faces: np.ndarray,
    adjacency: scipy.sparse.csr_matrix,
    *,
    rounds: int = 10,
    fold: float = -0.3,
) -> np.ndarray:
    """Vertices (V, 3) of a closed mesh with fewer faces that lie back on their neighbours.

    An edge is folded where the normals of its two faces have a product below `fold`. In each of `rounds` the
    vertices of faces at folded edges move to the mean of their neighbours (adjacency (V, V) of ones); where nothing
    is folded nothing moves.
    """
    pairs = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    order = np.lexsort(pairs.T)
    beside = (order % len(faces)).reshape(-1, 2)
    degree = np.asarray(adjacency.sum(axis=1))
    vertices = np.array(vertices, np.float64)
    for _ in range(rounds):
        normals = face_normals(vertices, faces)
        folded = (normals[beside[:, 0]] * normals[beside[:, 1]]).sum(axis=1) < fold
        if not folded.any():
            break
        move = np.unique(faces[beside[folded]])
        vertices[move] = (adjacency[move] @ vertices) / degree[move]
    return vertices
