"""Blends of a parametric space at bisected weights, and how far those of two spaces are from each other."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.blend_ready import ReadyBlends
from reperform.nodes.kernels.control_cells import lattice
from reperform.nodes.kernels.ground_plane import rotate_ground
from reperform.nodes.kernels.mesh_blend import MeshBlender, blend_linear

# velocities are per frame of this rate, as in the seeds
RATE = 25.0


class References(NamedTuple):
    """Reference motions of one space."""

    # (R, N) blend weights, and the reference at each lattice point of each cell (C, places)
    weights: np.ndarray
    places: np.ndarray
    # (K, R, 6 V) float32: root mean square distance of two poses is the norm of their difference
    features: np.ndarray
    # (R, K) seconds to the next pose
    seconds: np.ndarray


def reference_motions(
    vertices: np.ndarray, motion: np.ndarray, seconds: np.ndarray, cyclic: bool, faces: np.ndarray,
    corners: np.ndarray, subdivisions: int, velocity_weight: float, nonlinear: bool,
) -> References:  # fmt: skip
    """References of a space (fields as in ParametricSpace), cells bisected `subdivisions` times."""
    weights, places = lattice(corners, 2**subdivisions)
    poses = blended_poses(vertices, weights, faces, nonlinear)
    steps = np.tensordot(weights, motion, 1)
    times = weights @ seconds
    return References(weights, places, pose_features(poses, steps, times, cyclic, velocity_weight), times)


def blended_poses(
    vertices: np.ndarray, weights: np.ndarray, faces: np.ndarray, nonlinear: bool
) -> np.ndarray:
    """All poses (R, K, V, 3) of blends with weights (R, N) of inputs (N, K, V, 3)."""
    out = np.empty((len(weights), *vertices.shape[1:]), np.float32)
    blender = MeshBlender.build(vertices[0, 0], faces) if nonlinear else None
    for pose in range(vertices.shape[1]):
        meshes = [np.ascontiguousarray(mesh) for mesh in vertices[:, pose]]
        ready = ReadyBlends(blender, meshes) if blender is not None else None
        for row, weight in enumerate(weights):
            out[row, pose] = blend_linear(meshes, weight) if ready is None else ready.at(weight)
    return out


def pose_features(
    poses: np.ndarray, steps: np.ndarray, seconds: np.ndarray, cyclic: bool, velocity_weight: float
) -> np.ndarray:
    """Positions and velocities (K, R, 6 V) such that |a - b|^2 is d(a, b) of 004 eq 4.3 (R motions in step).

        d = 1/V (sum |x - y|^2 + velocity_weight sum |s - r|^2),  s(t) = x(t) - x(t - 1) in the root's frame

    poses (R, K, V, 3) in the frame of the root, m; steps (R, K, 3) of the root, seconds (R, K). Velocities include the
    root's travel and are in metres per 1/25 s; the first pose of a motion that is not cyclic takes that of the second.
    """
    count, length, vertices = poses.shape[:3]
    before = np.roll(poses, 1, axis=1).astype(np.float64)
    step, time = np.roll(steps, 1, axis=1), np.maximum(np.roll(seconds, 1, axis=1), 1e-6)
    before[..., [0, 2]] = rotate_ground(before[..., [0, 2]] - step[:, :, None, :2], -step[:, :, 2, None])
    velocity = (poses - before) / (RATE * time[:, :, None, None])
    if not cyclic:
        velocity[:, 0] = velocity[:, min(1, length - 1)]
    both = np.concatenate([poses, np.sqrt(velocity_weight) * velocity], axis=2) / np.sqrt(vertices)
    return np.ascontiguousarray(both.transpose(1, 0, 2, 3).reshape(length, count, -1), np.float32)


def squared_distances(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """|a_i - b_j|^2 of rows: (I, J) float32."""
    middle = 0.5 * (a.mean(axis=0) + b.mean(axis=0))
    x, y = a - middle, b - middle
    square = np.einsum("if,if->i", x, x)[:, None] + np.einsum("jf,jf->j", y, y)[None, :]
    return np.asarray(np.maximum(square - 2.0 * (x @ y.T), 0.0), np.float32)
