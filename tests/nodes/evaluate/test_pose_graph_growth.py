import numpy as np
import pytest

from reperform.nodes.evaluate.pose_graph_growth import pose_graph_growth
from reperform.nodes.products.mesh import MeshSequence


def take(frames: int, seed: int) -> MeshSequence:
    """A tetrahedron that sways."""
    corners = np.random.default_rng(7).normal(size=(4, 3))
    time = np.arange(frames)[:, None, None] / 9 + seed
    vertices = corners + 0.4 * np.sin(time + corners @ np.ones((3, 3)) * [1, 2, 3])
    faces = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]], np.int32)
    return MeshSequence(vertices.astype(np.float32), faces, np.float32(25))


def test_sizes_are_reached_across_takes_and_grow():
    meshes = {"a": take(40, 0), "b": take(50, 1), "c": take(60, 2)}
    found = pose_graph_growth(meshes, frames=(30, 60, 150, 151))
    value = dict(zip(found.name.tolist(), found.value[0].tolist(), strict=True))
    # matrices over all poses: memory grows with about the square
    assert 1.5 < value["memory exponent"] < 2.5
    assert value["memory 150"] > 150 * 150 * 8
    assert value["time 150"] > 0
    assert np.isnan(value["time 151"])


def test_what_a_single_size_leaves_open_is_unmeasured():
    found = pose_graph_growth({"a": take(20, 0)}, frames=(15,))
    value = dict(zip(found.name.tolist(), found.value[0].tolist(), strict=True))
    assert np.isnan(value["time exponent"])
    assert value["time 15"] == pytest.approx(value["time 15"])
