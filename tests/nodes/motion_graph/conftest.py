"""Transitions between the frames of three takes of a swinging point."""

import numpy as np
import pytest

from reperform.nodes.motion_graph.pose_transitions import pose_transitions
from reperform.nodes.products.essential import PoseTransitions
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity


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
