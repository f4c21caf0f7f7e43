"""The main part of a mesh."""

from __future__ import annotations

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import connected_components

from reperform.nodes.kernels.mesh_geometry import face_cross


def largest_component(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The connected part (by vertices) of a closed mesh that encloses most volume; loose vertices go.

    Cavities enclose negative volume and never win.
    """
    count = len(vertices)
    links = scipy.sparse.coo_matrix(
        (np.ones(2 * len(faces), np.int8), (faces[:, [0, 1]].ravel(), faces[:, [1, 2]].ravel())),
        shape=(count, count),
    )
    parts, label = connected_components(links, directed=False)
    volume = np.einsum("fi,fi->f", vertices[faces[:, 0]], face_cross(vertices, faces)) / 6
    best = np.bincount(label[faces[:, 0]], weights=volume, minlength=parts).argmax()
    return compact(vertices, faces[label[faces[:, 0]] == best])


def compact(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The mesh without vertices that no face uses; the order of the rest is kept."""
    used = np.zeros(len(vertices), bool)
    used[faces] = True
    return vertices[used], (np.cumsum(used) - 1)[faces].astype(np.int32)
