"""The distance between states of two parametric spaces by blending every mesh: what the tables stand for."""

from __future__ import annotations

import numpy as np

from reperform.nodes.kernels.blend_ready import ReadyBlends
from reperform.nodes.kernels.mesh_blend import MeshBlender
from reperform.nodes.kernels.reference_motions import pose_features
from reperform.nodes.products.parametric import ParametricSpace


def nonlinear_states(
    space: ParametricSpace, poses: np.ndarray, weights: np.ndarray, velocity_weight: float
) -> np.ndarray:
    """Features (S, 6 V) as in kernels.reference_motions of states (S,) poses, (S, N) weights, blended non-linearly.

    Every mesh is blended once: states share meshes, and velocities take the pose before (the first pose of a motion
    that is not cyclic takes that of the second).
    """
    vertices, motion, seconds = (np.asarray(field) for field in (space.vertices, space.motion, space.seconds))
    blender = MeshBlender.build(vertices[0, 0], np.asarray(space.faces))
    ready: dict[int, ReadyBlends] = {}
    made: dict[tuple[int, bytes], np.ndarray] = {}

    def mesh(pose: int, weight: np.ndarray) -> np.ndarray:
        key = (pose, weight.tobytes())
        if key not in made:
            if pose not in ready:
                ready[pose] = ReadyBlends(blender, list(vertices[:, pose]))
            made[key] = ready[pose].at(weight)
        return made[key]

    cyclic, length = bool(np.asarray(space.cyclic)), vertices.shape[1]
    out = []
    for pose, weight in zip(poses.tolist(), weights, strict=True):
        starts = not cyclic and pose == 0
        one, two = (0, 1) if starts else ((pose - 1) % length, pose)
        pair = np.stack([mesh(one, weight), mesh(two, weight)])[None]
        step, time = (np.tensordot(weight, field[:, [one, two]], 1)[None] for field in (motion, seconds))
        features = pose_features(pair, step, time, not starts, velocity_weight)
        out.append(features[0 if starts else 1, 0])
    return np.stack(out)
