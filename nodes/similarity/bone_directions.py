"""Dissimilarity of poses by the directions of their bones."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.deformation_metric import turns
from reperform.nodes.product import Pair
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.products.performance import SkeletonSequence


@node(over="pair")
def bone_directions(skeleton: Pair[SkeletonSequence]) -> Dissimilarity:
    """How far the bones of every frame of one take point from those of the other, in radians: (frame_a, frame_b).

        d(i, j) = sum_b l_b angle(u_b(i), R u_b(j)) / sum_b l_b

    over bones b from a joint to its child, u their unit directions and l their mean lengths. R is the turn about the
    vertical that lays the joints together in least squares.

    Raises ValueError where the skeletons differ in joints.
    Source: definition; Lee et al. 2002, SIGGRAPH (geodesic distances between orientations of joints).
    """
    a, b = skeleton
    if a.joints.shape[1] != b.joints.shape[1] or not np.array_equal(a.parents, b.parents):
        raise ValueError(
            f"similarity.bone_directions: both skeletons must have the same joints and parents, got "
            f"{a.joints.shape[1]} and {b.joints.shape[1]} joints"
        )
    first, second = (_centred(np.asarray(s.joints, np.float64)) for s in skeleton)
    yaw = turns(*(points[..., 0] + 1j * points[..., 2] for points in (first, second)))
    first, second, weight = _bones(first, second, np.asarray(a.parents))
    distance = np.empty(yaw.shape)
    for i in range(len(first)):
        cosine, sine = np.cos(yaw[i])[:, None], np.sin(yaw[i])[:, None]
        x, y, z = second[..., 0], second[..., 1], second[..., 2]
        placed = np.stack([cosine * x + sine * z, y, cosine * z - sine * x], axis=-1)
        chord = np.linalg.norm(first[i] - placed, axis=-1)
        distance[i] = 2 * np.arcsin(np.minimum(0.5 * chord, 1.0)) @ weight
    return Dissimilarity(distance.astype(np.float32))


def _centred(joints: np.ndarray) -> np.ndarray:
    """Joints with the mean of each frame over the origin of the ground."""
    return joints - joints.mean(axis=1, keepdims=True) * [1, 0, 1]


def _bones(
    first: np.ndarray, second: np.ndarray, parents: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unit directions of the bones of both, and the shares of their lengths."""
    child = np.flatnonzero(parents >= 0)
    vectors = [points[:, child] - points[:, parents[child]] for points in (first, second)]
    lengths = [np.linalg.norm(v, axis=-1) for v in vectors]
    mean = np.concatenate(lengths).mean(axis=0)
    units = [v / np.maximum(n, 1e-9)[..., None] for v, n in zip(vectors, lengths, strict=True)]
    return units[0], units[1], mean / mean.sum()
