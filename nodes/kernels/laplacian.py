"""Laplace operators, gradient and deformation gradients of triangle meshes, and their prefactored solves."""

from __future__ import annotations

import numpy as np
import scipy.sparse
from scipy.sparse.linalg import SuperLU, splu


def uniform_laplacian(faces: np.ndarray, n: int) -> scipy.sparse.csr_matrix:
    """Graph Laplacian D - A (n, n) of the edges of `faces`: symmetric, positive semi-definite."""
    adjacency = vertex_adjacency(faces, n)
    degree = np.asarray(adjacency.sum(axis=1)).ravel()
    return (scipy.sparse.diags(degree) - adjacency).tocsr()


def vertex_adjacency(faces: np.ndarray, n: int) -> scipy.sparse.csr_matrix:
    """Symmetric adjacency of vertices with ones along the edges, (n, n)."""
    i = np.concatenate([faces[:, 0], faces[:, 1], faces[:, 2]])
    j = np.concatenate([faces[:, 1], faces[:, 2], faces[:, 0]])
    adjacency = scipy.sparse.coo_matrix((np.ones(len(i)), (i, j)), shape=(n, n)).tocsr()
    adjacency = adjacency + adjacency.T
    adjacency.data[:] = 1.0
    return adjacency.tocsr()


def cotangent_laplacian(vertices: np.ndarray, faces: np.ndarray) -> scipy.sparse.csr_matrix:
    """Cotangent Laplacian L, (V, V): x . L x = integral of |grad x|^2; positive semi-definite, rows sum to 0.

    L_ij = -(cot a_ij + cot b_ij) / 2 for the angles opposite edge ij.
    Cotangents are computed from the edge vectors and bounded for slivers (|cot| <= 1e5).
    Source: Pinkall and Polthier 1993, Experimental Mathematics.
    """
    n = len(vertices)
    points = vertices.astype(np.float64)
    i, j, values = [], [], []
    for k in range(3):
        apex, one, two = faces[:, k], faces[:, (k + 1) % 3], faces[:, (k + 2) % 3]
        u, v = points[one] - points[apex], points[two] - points[apex]
        sine = np.linalg.norm(np.cross(u, v), axis=1)
        cotangent = np.einsum("fk,fk->f", u, v) / np.maximum(sine, 1e-30)
        i.append(one)
        j.append(two)
        values.append(0.5 * np.clip(cotangent, -1e5, 1e5))
    rows, columns, weights = np.concatenate(i), np.concatenate(j), np.concatenate(values)
    half = scipy.sparse.coo_matrix((weights, (rows, columns)), shape=(n, n)).tocsr()
    adjacency = half + half.T
    return (scipy.sparse.diags(np.asarray(adjacency.sum(axis=1)).ravel()) - adjacency).tocsr()


def gradient_operator(vertices: np.ndarray, faces: np.ndarray) -> scipy.sparse.csr_matrix:
    """Gradient G of functions linear on each face, (3 F, V); rows 3 f .. 3 f + 2 are face f's x, y, z.

    With x (V, 3) another placement of the mesh, J = (G @ x).reshape(F, 3, 3) is the transposed deformation
    gradient of each face: x_c - x_a = J^T (v_c - v_a) along its edges, J^T n = 0 along its normal.
    G^T diag(area) G is the cotangent Laplacian. Zero for faces without area.
    Source: Botsch, Sumner, Pauly and Gross 2006, VMV.
    """
    points = vertices.astype(np.float64)
    a, b, c = (points[faces[:, k]] for k in range(3))
    cross = np.cross(b - a, c - a)
    square = np.einsum("fk,fk->f", cross, cross)[:, None]
    # grad of the hat function of a corner: normal x opposite edge / (2 area)
    gradients = [
        np.divide(np.cross(cross, edge), square, out=np.zeros_like(cross), where=square > 1e-40)
        for edge in (c - b, a - c, b - a)
    ]
    count = len(faces)
    rows = np.repeat(np.arange(3 * count), 3)
    columns = np.repeat(faces, 3, axis=0).ravel()
    values = np.stack(gradients, axis=2).ravel()
    return scipy.sparse.csr_matrix((values, (rows, columns)), shape=(3 * count, len(vertices)))


def deformation_gradients(vertices: np.ndarray, deformed: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Per face the 3x3 matrix F with F e = e' for its edges and F n = n' for its unit normals, (F, 3, 3).

    Source: Sumner and Popovic 2004, SIGGRAPH. Departure: unit normals on both sides, so that F is a pure
    rotation for a rigid motion whatever the scale, and the determinant is the ratio of areas.
    """
    frame = _edge_frames(vertices.astype(np.float64), faces)
    other = _edge_frames(deformed.astype(np.float64), faces)
    return other @ np.linalg.inv(frame)


def _edge_frames(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    a, b, c = (points[faces[:, k]] for k in range(3))
    u, v = b - a, c - a
    normal = np.cross(u, v)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
    return np.stack([u, v, normal], axis=2)


def factorise(matrix: scipy.sparse.spmatrix) -> SuperLU:
    """Factor a symmetric positive definite sparse matrix once; `.solve(b)` is then two triangular solves."""
    return splu(
        scipy.sparse.csc_matrix(matrix),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
