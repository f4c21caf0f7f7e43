"""How far a surface reaches along itself: false joins between limbs make it less."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from reperform.nodes.kernels.mesh_geometry import edges, volume


def geodesic_reach(vertices: np.ndarray, faces: np.ndarray, count: int = 6) -> float:
    """The sum of the distances at which `count` farthest points follow each other, over the cube root of the volume.

    vertices (V, 3) m, faces (F, 3). From the highest vertex on, each point is the one farthest, along edges, from all
    before it: of a person the ends of the limbs. Bending limbs leaves distances along the surface as they are, and a
    join that is not there can only shorten them, so that of all poses of one performer the one that reaches farthest
    has fewest false joins. Vertices that no edge path reaches do not count.
    Source: Eldar et al. 1997, IEEE TIP 6(9) (farthest point sampling); Elad and Kimmel 2003, IEEE TPAMI 25(10)
    (geodesic distances are kept under bending).
    """
    points = np.asarray(vertices, np.float64)
    ends = edges(faces)
    length = np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1)
    graph = csr_matrix((length, (ends[:, 0], ends[:, 1])), shape=(len(points),) * 2)
    nearest = _from(graph, int(points[:, 1].argmax()))
    nearest[np.isinf(nearest)] = 0
    total = 0.0
    for _ in range(count):
        total += float(nearest.max())
        nearest = np.minimum(nearest, _from(graph, int(nearest.argmax())))
    return total / max(float(volume(points, faces)), 1e-9) ** (1 / 3)


def _from(graph: csr_matrix, start: int) -> np.ndarray:
    return np.asarray(dijkstra(graph, directed=False, indices=start))
