"""Vertex and velocity dissimilarity of frames that share a topology."""

from __future__ import annotations

import hashlib
from typing import Annotated, Literal

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.ground_plane_distance import ground_plane_distance
from reperform.nodes.product import Pair
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity


@node(over="pair", memory=1.0)
def vertex_velocity(
    mesh: Pair[MeshSequence],
    *,
    velocity_weight: Annotated[
        float, Param("1", 0.0, 100.0, "weight of the difference of motion per frame against that of shape")
    ] = 1.0,
    align: Annotated[
        Literal["yaw_and_offset", "offset", "none"],
        Param(about="ground-plane motion that does not count as a difference"),
    ] = "yaw_and_offset",
) -> Dissimilarity:
    """How far every frame of one take is from every frame of the other, in metres: (frame_a, frame_b).

    d(i, j) = min over a turn about the vertical and a shift on the ground of sqrt(1/N (sum |X_i - X_j|^2 +
    velocity_weight sum |V_i - V_j|^2)), V(t) = X(t) - X(t - 1) in metres per frame (the first frame takes
    the velocity of the second). All pairs at once, in closed form.

    Raises ValueError where the takes differ in topology or frame rate.

    Source: 001 section 3.2.1 (Casas, Tejera, Guillemaut and Hilton, IEEE TVCG 2013); ground-plane motion:
    Kovar, Gleicher and Pighin, SIGGRAPH 2002.
    Departure: the root, so that the unit is the metre and the triangle inequality holds; a dissimilarity,
    since s = 1 - d / max d cannot be compared between pairs of takes; least over the ground-plane motion of
    the whole sum, since takes start anywhere in the studio.
    """
    a, b = mesh
    _require_same_topology(a, b)
    if not np.isclose(a.fps, b.fps, rtol=1e-4):
        raise ValueError(
            f"vertex_velocity: both takes must have one frame rate, got {float(a.fps):g} and "
            f"{float(b.fps):g} Hz: resample one of them"
        )
    distance = ground_plane_distance(
        a.vertices, b.vertices, _velocity(a.vertices), _velocity(b.vertices), velocity_weight, align
    )
    return Dissimilarity(distance.astype(np.float32))


def _velocity(vertices: np.ndarray) -> np.ndarray:
    if len(vertices) < 2:
        return np.zeros_like(vertices)
    steps = np.diff(vertices, axis=0)
    return np.concatenate([steps[:1], steps])


def _require_same_topology(a: MeshSequence, b: MeshSequence) -> None:
    digests = [
        hashlib.blake2b(np.ascontiguousarray(m.faces).tobytes(), digest_size=6).hexdigest() for m in (a, b)
    ]
    counts = [m.vertices.shape[1] for m in (a, b)]
    if digests[0] != digests[1] or counts[0] != counts[1]:
        raise ValueError(
            "vertex_velocity: both takes must share one topology, got "
            f"{counts[0]} vertices with faces {digests[0]} and {counts[1]} vertices with faces {digests[1]}: "
            "align the takes first (align.register)"
        )
