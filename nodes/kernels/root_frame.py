"""Where a body stands and which way it faces, so that its poses can be told from its travel."""

from __future__ import annotations

import numpy as np

from reperform.nodes.kernels.ground_plane import rotate_ground

_ROUNDS = 3


def facing(vertices: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Yaw (T,) by which the reference (V, 3) must turn about the vertical to fit each pose (T, V, 3) best, unwrapped.

    Closed form of the least-squares fit of the ground coordinates, as in kernels.ground_plane.align.
    """
    points = _centred(vertices)
    x, z = _centred(reference)
    sine = points[0] @ z - points[1] @ x
    cosine = points[0] @ x + points[1] @ z
    return np.unwrap(np.arctan2(sine, cosine))


def mean_shape(vertices: np.ndarray) -> np.ndarray:
    """The mean pose (V, 3) of a take once its poses face one way, over the origin, facing +z where it travels.

    A body that goes less than its own height faces as in its first frame.
    """
    reference = vertices[0].astype(np.float64)
    for _ in range(_ROUNDS):
        reference = to_root(vertices, reference)[0].mean(axis=0)
    local, track, yaw = to_root(vertices, reference)
    ahead = rotate_ground(np.diff(track, axis=0), -yaw[:-1]).sum(axis=0) if len(track) > 1 else np.zeros(2)
    if np.hypot(*ahead) > np.ptp(local[..., 1]):
        reference[:, [0, 2]] = rotate_ground(reference[:, [0, 2]], -float(np.arctan2(ahead[0], ahead[1])))
    return reference


def to_root(vertices: np.ndarray, reference: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Poses in their own frame (T, V, 3), the ground track (T, 2) of their mean vertex, and their yaw (T,)."""
    points = vertices.astype(np.float64)
    track, yaw = points[..., [0, 2]].mean(axis=1), facing(vertices, reference)
    points[..., [0, 2]] = rotate_ground(points[..., [0, 2]] - track[:, None], -yaw[:, None])
    return points, track, yaw


def root_steps(track: np.ndarray, yaw: np.ndarray) -> np.ndarray:
    """From each pose to the next in the frame of the first of them: (T - 1, 3) dx, dz (m), dyaw (rad)."""
    ground = rotate_ground(np.diff(track, axis=0), -yaw[:-1])
    return np.column_stack([ground, np.diff(yaw)])


def travel(steps: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Track (..., T + 1, 2) and yaw (..., T + 1) from the origin, by steps (..., T, 3)."""
    zero = np.zeros((*steps.shape[:-2], 1))
    yaw = np.concatenate([zero, np.cumsum(steps[..., 2], axis=-1)], axis=-1)
    ground = np.cumsum(rotate_ground(steps[..., :2], yaw[..., :-1]), axis=-2)
    return np.concatenate([np.zeros((*ground.shape[:-2], 1, 2)), ground], axis=-2), yaw


def _centred(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    ground = points[..., [0, 2]].astype(np.float64)
    ground -= ground.mean(axis=-2, keepdims=True)
    return ground[..., 0], ground[..., 1]
