"""A small performer whose takes loop, drift and turn, and the graph made of them."""

from collections.abc import Mapping

import numpy as np
import pytest
import trimesh

from reperform.nodes.motion_graph.essential import essential
from reperform.nodes.motion_graph.pose_transitions import pose_transitions
from reperform.nodes.motion_graph.surface import surface
from reperform.nodes.products.essential import PoseGraph
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity, MotionGraph
from reperform.nodes.similarity.vertex_velocity import vertex_velocity


def walker(frames: int, speed: float, turn: float, phase: float) -> MeshSequence:
    """An uneven blob that swings with period 20 frames, goes `speed` m/s and turns `turn` rad/s."""
    mesh = trimesh.creation.icosphere(subdivisions=2)
    rest = np.asarray(mesh.vertices) * [0.25, 0.85, 0.15]
    rest[:, 0] += 0.1 * rest[:, 1] ** 2
    out = []
    place, heading = np.array([0.3, -0.2]), 0.4
    for k in range(frames):
        angle = 2 * np.pi * (k + phase) / 20
        swing = 0.3 * np.sin(angle) * rest[:, 1] + 0.1 * np.cos(angle)
        x, y, z = rest[:, 0], rest[:, 1] + 0.9 + 0.02 * np.cos(2 * angle), rest[:, 2] + swing
        c, s = np.cos(heading), np.sin(heading)
        out.append(np.stack([c * x + s * z + place[0], y, -s * x + c * z + place[1]], axis=1))
        place = place + np.array([s, c]) * speed / 25
        heading += turn / 25
    return MeshSequence(
        np.array(out, np.float32), np.asarray(mesh.faces, np.int32), np.asarray(25.0, np.float32)
    )


@pytest.fixture(scope="session")
def meshes() -> Mapping[str, MeshSequence]:
    return {
        "slow": walker(70, 0.6, 0.0, 0.0),
        "fast": walker(60, 1.5, 0.1, 3.0),
        "turn": walker(65, 0.8, -0.7, 7.0),
    }


@pytest.fixture(scope="session")
def graph(meshes: Mapping[str, MeshSequence]) -> MotionGraph:
    similarity = {(a, b): vertex_velocity((meshes[a], meshes[b])) for a in meshes for b in meshes}
    return surface(similarity, meshes, transitions=8)


@pytest.fixture(scope="session")
def strides() -> Mapping[str, MeshSequence]:
    """Short takes for graphs of poses."""
    return {
        "ahead": walker(26, 1.3, 0.0, 0.0),
        "left": walker(28, 1.2, 0.8, 4.0),
        "right": walker(24, 1.2, -0.8, 11.0),
    }


@pytest.fixture(scope="session")
def likeness(strides: Mapping[str, MeshSequence]) -> Mapping[tuple[str, str], Dissimilarity]:
    return {(a, b): vertex_velocity((strides[a], strides[b])) for a in strides for b in strides}


@pytest.fixture(scope="session")
def pose_graph(
    strides: Mapping[str, MeshSequence], likeness: Mapping[tuple[str, str], Dissimilarity]
) -> PoseGraph:
    return essential(
        {
            (a, b): pose_transitions(matrix, (strides[a], strides[b]), alpha=0.02, shortest=0.2, longest=0.5)
            for (a, b), matrix in likeness.items()
        }
    )
