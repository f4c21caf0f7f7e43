import numpy as np
import pytest

from reperform.nodes.evaluate.smoothness import smoothness
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph

POINTS = np.random.default_rng(3).normal(size=(30, 3)) * [0.3, 0.9, 0.2]
FACES, FPS = np.array([[0, 1, 2]], np.int32), np.float32(25)


def _graph() -> MotionGraph:
    one, two = np.array([0, 1], np.int32), np.array([1, 0], np.int32)
    return MotionGraph(
        np.array(["a", "b"]), np.array([9, 9], np.int32), one, two, np.array([4, 4], np.int32),
        np.array([4, 5], np.int32), np.array([3, 3], np.int32), np.zeros(2, np.float32), np.zeros(2),
        np.zeros((2, 2)), np.ones(2, bool), FPS,
    )  # fmt: skip


def test_one_row_per_transition_in_metres() -> None:
    low = np.repeat(POINTS[None], 9, axis=0).astype(np.float32)
    high = low + np.float32([0, 1e-3, 0])
    found = smoothness(_graph(), {"a": MeshSequence(low, FACES, FPS), "b": MeshSequence(high, FACES, FPS)})
    np.testing.assert_allclose(found.value, [[1e-3], [1e-3]], rtol=1e-3)
    assert found.unit.tolist() == ["m"]


def test_other_meshes_are_refused() -> None:
    meshes = {"a": MeshSequence(np.zeros((9, 30, 3), np.float32), FACES, FPS)}
    with pytest.raises(ValueError, match="the graph has take 'b', the meshes have a"):
        smoothness(_graph(), meshes)
