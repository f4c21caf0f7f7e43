"""Where a surface is pulled by the one it is fitted to."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from scipy.spatial import cKDTree

from reperform.nodes.kernels.graph_fit import welsch
from reperform.nodes.kernels.mesh_geometry import vertex_areas, vertex_normals


class FitTarget(NamedTuple):
    """A surface to be fitted, with what is looked up again and again."""

    vertices: np.ndarray  # (N, 3) float64, m
    normals: np.ndarray  # (N, 3)
    share: np.ndarray  # (N,) area of each vertex over the mean area
    tree: cKDTree  # of places and scaled normals (N, 6)


def fit_target(vertices: np.ndarray, faces: np.ndarray, normal_length: float) -> FitTarget:
    """Prepare a surface; normals count in the search for the closest point like a distance of
    `normal_length` (m)."""
    vertices = np.ascontiguousarray(vertices, np.float64)
    normals = vertex_normals(vertices, faces)
    areas = vertex_areas(vertices, faces)
    tree = cKDTree(np.hstack([vertices, normal_length * normals]))
    return FitTarget(vertices, normals, areas / areas.mean(), tree)


def surface_pull(
    moved: np.ndarray,
    normals: np.ndarray,
    share: np.ndarray,
    target: FitTarget,
    scale: float,
    normal_length: float,
    tangential: float,
) -> tuple[np.ndarray, np.ndarray, float]:
    """Pull (V, 3, 3) and force (V, 3) on the vertices `moved` (V, 3) from two-way closest points, and the
    cost (m).

    Every vertex is drawn to the tangent plane at its closest target vertex, and every target vertex draws
    its closest vertex to its own; closest in place and normal together. Weights: area share x
    Welsch(distance; scale) x (n . n')^2 where the normals agree, else 0. A share `tangential` of each pull
    acts in all directions. The cost is the mean over both ways of the Welsch loss as a length, scale sqrt(2
    (1 - weight)).
    """
    tree = cKDTree(np.hstack([moved, normal_length * normals]))
    forth = target.tree.query(np.hstack([moved, normal_length * normals]))[1]
    back = tree.query(np.hstack([target.vertices, normal_length * target.normals]))[1]
    return _pull(
        moved,
        normals,
        share,
        target.vertices,
        target.normals,
        target.share,
        forth,
        back,
        scale,
        tangential,
    )


@njit(cache=True, nogil=True)
def _pull(
    moved: np.ndarray,
    normals: np.ndarray,
    share: np.ndarray,
    vertices: np.ndarray,
    target_normals: np.ndarray,
    target_share: np.ndarray,
    forth: np.ndarray,
    back: np.ndarray,
    scale: float,
    tangential: float,
) -> tuple[np.ndarray, np.ndarray, float]:
    pull = np.zeros((len(moved), 3, 3))
    force = np.zeros((len(moved), 3))
    loss = total = 0.0
    for way in range(2):
        for s in range(len(moved) if way == 0 else len(vertices)):
            i, j = (s, forth[s]) if way == 0 else (back[s], s)
            area = share[i] if way == 0 else target_share[j]
            agree = square = 0.0
            for c in range(3):
                agree += normals[i, c] * target_normals[j, c]
                square += (moved[i, c] - vertices[j, c]) ** 2
            w = welsch(square, scale) * max(agree, 0.0) ** 2
            loss += area * (1 - w)
            total += area
            w *= area
            if w == 0:
                continue
            height = 0.0
            for c in range(3):
                height += target_normals[j, c] * (vertices[j, c] - moved[i, c])
            for r in range(3):
                away = vertices[j, r] - moved[i, r]
                force[i, r] += w * ((1 - tangential) * height * target_normals[j, r] + tangential * away)
                pull[i, r, r] += w * tangential
                for c in range(3):
                    pull[i, r, c] += w * (1 - tangential) * target_normals[j, r] * target_normals[j, c]
    return pull, force, scale * np.sqrt(2 * loss / max(total, 1e-12))
