"""Mean distance between two surfaces."""

from __future__ import annotations

import numpy as np

from reperform.nodes.kernels.closest_point import closest_points
from reperform.nodes.kernels.mesh_geometry import vertex_areas


def mean_distance(
    vertices: np.ndarray, faces: np.ndarray, other_vertices: np.ndarray, other_faces: np.ndarray
) -> float:
    """Mean over the area of a mesh of the distance to the nearest point of another, in the unit of the vertices.

    sum_v A_v min_y |x_v - y| / sum_v A_v over the vertices, A_v a third of the faces around; y runs over all points of
    the other's triangles. nan where the mesh has no area.
    """
    areas = vertex_areas(np.asarray(vertices, np.float64), faces)
    used = areas > 0
    if not used.any():
        return float("nan")
    distance = closest_points(vertices[used], other_vertices, other_faces)[2]
    return float(areas[used] @ distance / areas[used].sum())
