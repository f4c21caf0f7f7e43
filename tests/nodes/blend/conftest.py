import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.rotation import exp
from reperform.nodes.products.mesh import MeshSequence

AXIS = np.array([0.1, 0.2, 1.0])


@pytest.fixture(scope="session")
def swing():
    """A slab with a bulge that swings about its end by up to `angle` (radians) about an axis, over 4 poses."""
    box = trimesh.creation.box(extents=[0.2, 1.0, 0.12]).subdivide().subdivide()
    vertices = np.asarray(box.vertices) - [0.05, 0.5, 0.0]
    vertices[:, 2] += 0.1 * np.exp(-20 * (vertices[:, 1] + 0.6) ** 2) * (vertices[:, 2] > 0)
    faces = np.asarray(box.faces, np.int32)

    def made(angle: float, axis: np.ndarray = AXIS) -> MeshSequence:
        turns = [exp(axis / np.linalg.norm(axis) * angle * (k + 1) / 4) for k in range(4)]
        frames = np.array([vertices @ turn.T + [0.0, 1.0, 0.0] for turn in turns], np.float32)
        return MeshSequence(frames, faces, np.asarray(25.0, np.float32))

    return made
