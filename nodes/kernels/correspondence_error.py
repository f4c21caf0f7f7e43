"""How far aligned surfaces are from the true correspondences."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.closest_point import closest_points


class SurfacePoints(NamedTuple):
    """Points fixed to a mesh: `barycentric` (N, 3) on triangle `face` (N,)."""

    face: np.ndarray
    barycentric: np.ndarray

    def on(self, vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
        """Where the points are when the mesh has these vertices (..., V, 3): (..., N, 3)."""
        corners = vertices[..., faces[self.face], :]
        return np.einsum("nk,...nkc->...nc", self.barycentric, corners)


def attach(points: np.ndarray, vertices: np.ndarray, faces: np.ndarray) -> SurfacePoints:
    """Fix points (N, 3) to the closest places of a mesh: what an aligned vertex of the root frame truly
    is."""
    face, barycentric, _ = closest_points(points, vertices, faces)
    return SurfacePoints(face, barycentric)


def correspondence_error(
    aligned: np.ndarray, truth_points: SurfacePoints, truth_vertices: np.ndarray, truth_faces: np.ndarray
) -> np.ndarray:
    """Distance (m) of every aligned vertex from the true place of the point it stands for: (frame, vertex).

    aligned: (frame, V, 3); truth_vertices: (frame, Vt, 3) the true mesh at the same frames; truth_points:
    the aligned vertices of the root frame attached to the true mesh at the root frame (`attach`). What the
    reconstruction adds to the surface (a visual hull is fatter than the body) is part of the error, so it
    does not start at zero.
    """
    return np.linalg.norm(truth_points.on(truth_vertices, truth_faces) - aligned, axis=-1)


def swap_rate(
    aligned: np.ndarray,
    truth_points: SurfacePoints,
    truth_vertices: np.ndarray,
    truth_faces: np.ndarray,
    side: np.ndarray,
    opposite_limb: np.ndarray,
) -> np.ndarray:
    """Share of limb vertices whose nearest limb is the one of the other side, per frame: (frame,).

    side: (Vt,) -1 right, +1 left, 0 neither, per true vertex; opposite_limb: (Vt,) label of the limb
    segment without its side (thigh, shin, foot, ...), so a hand beside the other thigh is no swap. A vertex
    that stands for a point of a sided segment is swapped where the same segment's other side is nearer to
    it than its own by more than the thickness of a limb's skin (half the mean distance of the two).
    """
    own_face = truth_faces[truth_points.face, truth_points.barycentric.argmax(axis=1)]
    own_side, own_limb = side[own_face], opposite_limb[own_face]
    rates = np.zeros(len(aligned))
    sided = own_side != 0
    if not sided.any():
        return rates
    for k, (points, truth) in enumerate(zip(aligned, truth_vertices, strict=True)):
        swapped = np.zeros(len(points), bool)
        for limb in np.unique(own_limb[sided]):
            left, right = (np.flatnonzero((opposite_limb == limb) & (side == s)) for s in (1, -1))
            for hand, other in ((left, right), (right, left)):
                members = np.flatnonzero((own_limb == limb) & (own_side == (1 if hand is left else -1)))
                if not len(members) or not len(other):
                    continue
                own = _nearest(points[members], truth[hand])
                across = _nearest(points[members], truth[other])
                swapped[members] = across < 0.5 * own
        rates[k] = swapped[sided].mean()
    return rates


def _nearest(points: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    from scipy.spatial import cKDTree

    return np.asarray(cKDTree(vertices).query(points)[0])
