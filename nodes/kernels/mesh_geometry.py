"""Normals, areas, volume, centroids and edges of triangle meshes.

All functions take vertices (..., V, 3) and faces (F, 3), counter-clockwise seen from outside; leading axes of
the vertices (frames) are carried through.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse

# Below this twice-area (m^2) a triangle has no direction of its own.
_DEGENERATE = 1e-20


def face_cross(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Cross product of two edges per face, (..., F, 3): normal times twice the area."""
    a, b, c = (vertices[..., faces[:, k], :] for k in range(3))
    return np.cross(b - a, c - a)


def face_normals(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Unit outward normals, (..., F, 3); zero where a face has no area."""
    return _unit(face_cross(vertices, faces))


def face_areas(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Areas, (..., F), in square metres."""
    return 0.5 * np.linalg.norm(face_cross(vertices, faces), axis=-1)


def vertex_normals(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Unit normals at vertices, (..., V, 3): area-weighted mean of the faces around; zero if loose."""
    count = vertices.shape[-2]
    cross = face_cross(vertices, faces)
    flat = cross.reshape(-1, len(faces), 3)
    gather = _vertex_of_face_matrix(faces, count)
    sums = np.stack([gather @ frame for frame in flat]) if len(flat) else np.zeros((0, count, 3))
    return _unit(sums.reshape(*cross.shape[:-2], count, 3)).astype(vertices.dtype, copy=False)


def vertex_areas(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Area that belongs to each vertex of one mesh (V,): a third of the faces around it."""
    gather = _vertex_of_face_matrix(faces, vertices.shape[-2])
    return np.asarray(gather @ face_areas(vertices, faces)) / 3.0


def vertex_means(values: np.ndarray, faces: np.ndarray, count: int) -> np.ndarray:
    """Mean (count, C) over the faces around each vertex of values at faces (F, C); 0 for a loose vertex."""
    gather = _vertex_of_face_matrix(faces, count)
    around = np.bincount(faces.ravel(), minlength=count)
    return np.asarray(gather @ values) / np.maximum(around, 1)[:, None]


def volume(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Signed volume (...,) of closed meshes, in cubic metres: sum over faces of a . (b x c) / 6.

    It is positive where faces are counter-clockwise from outside; on an open mesh it depends on the origin.
    """
    a, b, c = (vertices[..., faces[:, k], :].astype(np.float64) for k in range(3))
    return np.einsum("...fk,...fk->...", a, np.cross(b, c)) / 6.0


def centroid(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Centre of the surface (..., 3): area-weighted mean of the faces' centres; vertex density has no say."""
    corners = vertices[..., faces, :].astype(np.float64)
    areas = face_areas(vertices, faces).astype(np.float64)[..., None]
    return (corners.mean(-2) * areas).sum(-2) / np.maximum(areas.sum(-2), _DEGENERATE)


def edges(faces: np.ndarray) -> np.ndarray:
    """Undirected edges (E, 2) int32, smaller index first, sorted."""
    pairs = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return np.unique(np.sort(pairs, axis=1), axis=0).astype(np.int32)


def _vertex_of_face_matrix(faces: np.ndarray, count: int) -> scipy.sparse.csr_matrix:
    rows = faces.ravel()
    columns = np.repeat(np.arange(len(faces)), 3)
    return scipy.sparse.csr_matrix((np.ones(len(rows)), (rows, columns)), shape=(count, len(faces)))


def _unit(vectors: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > _DEGENERATE)
