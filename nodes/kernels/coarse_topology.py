"""One coarser topology for all poses of a mesh."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.closest_point import closest_points
from reperform.nodes.kernels.decimate import decimate, is_closed


class CoarseTopology(NamedTuple):
    """Fewer vertices, each a fixed point of a face of the fine mesh."""

    faces: np.ndarray
    # per coarse vertex three vertices of the fine mesh (V', 3) and their weights, rows of sum 1
    corners: np.ndarray
    weights: np.ndarray

    def apply(self, vertices: np.ndarray) -> np.ndarray:
        """The coarse vertices (..., V', 3) of any pose (..., V, 3), in its dtype."""
        total = sum(vertices[..., self.corners[:, k], :] * self.weights[:, k, None] for k in range(3))
        return np.asarray(total).astype(vertices.dtype)


def coarse_topology(reference: np.ndarray, faces: np.ndarray, budget: int) -> CoarseTopology:
    """Decimate one pose and bind the result to it, so that every other pose can follow.

    reference: (V, 3), m; budget: how many vertices to keep; not below V: the mesh as it is.
    Raises ValueError where the mesh is not closed.
    """
    if len(reference) <= budget:
        own = np.arange(len(reference))
        return CoarseTopology(
            np.asarray(faces, np.int32), np.stack([own] * 3, axis=1), np.tile([1.0, 0.0, 0.0], (len(own), 1))
        )
    if not is_closed(np.asarray(faces)):
        raise ValueError(
            "coarsen: the mesh must be closed (every edge in two faces): only then can it be decimated"
        )
    points, coarse = decimate(np.asarray(reference, np.float64), np.asarray(faces, np.int32), budget)
    face, weights, _ = closest_points(points, reference, faces)
    return CoarseTopology(coarse.astype(np.int32), np.asarray(faces)[face], weights)
