"""Dissimilarity of the point clouds that a motion sweeps over a short window."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.joint_weights import joint_weights
from reperform.nodes.kernels.one_topology import require_one_rate, require_one_topology
from reperform.nodes.kernels.point_cloud_distance import point_cloud_distance
from reperform.nodes.product import Pair
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.products.performance import SkeletonSequence

_WHO = "similarity.point_cloud"


@node(over="pair", memory=1.0)
def point_cloud(
    mesh: Pair[MeshSequence] | None = None,
    skeleton: Pair[SkeletonSequence] | None = None,
    *,
    window: Annotated[float, Param("s", 0.0, 2.0, "length of the window around each frame")] = 0.32,
    taper: Annotated[
        Literal["tent", "box"], Param(about="weight of the window's frames: falling to both ends, or equal")
    ] = "tent",
    weights: Annotated[dict[str, float], Param(about="weight of joints by name, >= 0; others have 1")] = {},  # noqa: B006
) -> Dissimilarity:
    """How far the motion around every frame of one take is from that of the other, in metres: (frame_a, frame_b).

    D(i, j)^2 = min over a turn about the vertical and a shift on the ground of the weighted mean of
    |p_i+k - M p'_j+k|^2 over all points p and the frames |k| <= n of the window, n = window fps / 2; one M for the
    whole window, so that motions of one pose in opposite directions differ. At the ends of a take the window holds
    the frames that exist. Points are the vertices, or the joints with their weights.

    Raises ValueError unless exactly one of mesh and skeleton is wired, where takes differ in topology, joints or
    frame rate, or a weighted joint does not exist.

    Source: 003 section 3.2.1, eq 5; Kovar, Gleicher and Pighin 2002, SIGGRAPH, section 3.1.
    Departure: the alignment is that of the whole window, not a low-pass filter over frames aligned one by one; the
    root of the mean, so that the unit is the metre.
    """
    if (mesh is None) == (skeleton is None):
        number = "neither" if mesh is None else "both"
        raise ValueError(
            f"{_WHO}: exactly one of the inputs 'mesh' and 'skeleton' must be wired, got {number}"
        )
    if mesh is not None:
        a, b, fps = *_vertices(mesh), mesh[0].fps
        share = np.ones(a.shape[1])
    elif skeleton is not None:
        a, b, fps = skeleton[0].joints, skeleton[1].joints, skeleton[0].fps
        share = _joint_share(skeleton, weights)
    half = round(window * float(fps) / 2)
    frames = np.abs(np.arange(-half, half + 1))
    falling = 1 - frames / (half + 1) if taper == "tent" else np.ones(len(frames))
    return Dissimilarity(point_cloud_distance(a, b, share, falling).astype(np.float32))


def _vertices(mesh: Pair[MeshSequence]) -> tuple[np.ndarray, np.ndarray]:
    a, b = mesh
    require_one_topology(_WHO, (a.faces, b.faces), (a.vertices.shape[1], b.vertices.shape[1]))
    require_one_rate(_WHO, a.fps, b.fps)
    return a.vertices, b.vertices


def _joint_share(skeleton: Pair[SkeletonSequence], weights: dict[str, float]) -> np.ndarray:
    names, others = ([str(name) for name in np.asarray(take.names)] for take in skeleton)
    if names != others:
        raise ValueError(f"{_WHO}: both takes must have the same joints, got {len(names)} and {len(others)}")
    require_one_rate(_WHO, skeleton[0].fps, skeleton[1].fps)
    return joint_weights(_WHO, names, weights)
