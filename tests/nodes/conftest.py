"""Scenes: a walking skeleton made by hand; transitions of a swinging point."""

from collections.abc import Mapping

import numpy as np
import pytest

from reperform.nodes.kernels.articulation import joint_positions
from reperform.nodes.kernels.rotation import exp
from reperform.nodes.motion_graph.pose_transitions import pose_transitions
from reperform.nodes.products.essential import PoseTransitions
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.mocap import Mocap
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.products.performance import SkeletonSequence

NAMES = (
    "root",
    "l_hip",
    "l_knee",
    "l_ankle",
    "l_ball",
    "r_hip",
    "r_knee",
    "r_ankle",
    "r_ball",
    "neck",
    "neck_end",
)
PARENTS = np.array([-1, 0, 1, 2, 3, 0, 5, 6, 7, 0, 9], np.int32)
_LEG = [(0, -0.1, 0.0), (0, -0.42, 0.02), (0, -0.40, -0.02), (0.0, -0.06, 0.13)]
OFFSET = np.array(
    [
        (0, 0, 0),
        (0.1, *_LEG[0][1:]),
        *_LEG[1:],
        (-0.1, *_LEG[0][1:]),
        *_LEG[1:],
        (0, 0.45, -0.01),
        (0, 0.2, 0.03),
    ]
)


def walker(frames: int, speed: float, turn: float, phase: float, fps: float = 25.0) -> Mocap:
    """Goes `speed` m/s and turns `turn` rad/s with a step cycle of 24 frames; feet are set down and lifted again."""
    heading = 0.3 + turn * np.arange(frames) / fps
    velocity = speed / fps * np.stack([np.sin(heading), np.zeros(frames), np.cos(heading)], axis=1)
    root = np.cumsum(velocity, axis=0) + [0.2, 0.0, -0.4]
    rotation = np.empty((frames, len(PARENTS), 3, 3))
    rotation[:] = exp(np.stack([0 * heading, heading, 0 * heading], axis=1))[:, None]
    for side, first in ((0.0, 1), (0.5, 5)):
        cycle = 2 * np.pi * (np.arange(frames) + phase) / 24 + 2 * np.pi * side
        swing = 0.5 * speed * 24 / fps / 2 * np.cos(cycle)
        bend = 0.25 + 0.35 * np.maximum(-np.sin(cycle), 0.0)
        x = np.zeros(frames)
        hip, knee, flat = (
            exp(np.stack([angle, x, x], axis=1)) for angle in (-swing - bend / 2, bend / 2 - swing, x)
        )
        for joint, local in ((first, hip), (first + 1, knee), (first + 2, flat), (first + 3, flat)):
            rotation[:, joint] = rotation[:, 0] @ local
    joints = joint_positions(PARENTS, OFFSET, root, rotation)
    balls = joints[:, [4, 8], 1].min(axis=1)
    root[:, 1] -= balls - 0.02
    joints[..., 1] -= (balls - 0.02)[:, None]
    skeleton = SkeletonSequence(
        joints.astype(np.float32), PARENTS, np.array(NAMES), np.array(fps, np.float32)
    )
    return Mocap(skeleton, rotation.astype(np.float32), OFFSET.astype(np.float32))


@pytest.fixture(scope="session")
def striders() -> Mapping[str, Mocap]:
    """Takes of one skeleton."""
    return {
        "slow": walker(80, 0.7, 0.0, 0.0),
        "quick": walker(70, 1.1, 0.1, 5.0),
        "turning": walker(75, 0.8, -0.5, 9.0),
    }


@pytest.fixture(scope="session")
def pose_pairs() -> dict[tuple[str, str], PoseTransitions]:
    """Every ordered pair of takes of 20, 13 and 9 frames, 12 Hz, alpha 0.05."""
    time = {"a": np.arange(20.0), "b": 0.7 * np.arange(13) + 3, "c": np.arange(9.0)[::-1] * 1.3}
    place = {
        take: np.stack([np.sin(0.5 * t), np.cos(0.8 * t + 1), 0.1 * (ord(take) - 97) + 0 * t], 1)
        for take, t in time.items()
    }
    meshes = {
        take: MeshSequence(
            np.zeros((len(t), 3, 3), np.float32), np.array([[0, 1, 2]], np.int32), np.float32(12)
        )
        for take, t in time.items()
    }
    pairs = {}
    for a in place:
        for b in place:
            distance = np.linalg.norm(place[a][:, None] - place[b][None], axis=2).astype(np.float32)
            pairs[a, b] = pose_transitions(
                Dissimilarity(distance), (meshes[a], meshes[b]), alpha=0.05, shortest=0.25, longest=1.0
            )
    return pairs
