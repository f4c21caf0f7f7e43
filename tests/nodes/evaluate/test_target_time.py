import numpy as np
import pytest

from reperform.nodes.evaluate.target_time import target_time
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph

FACES, FPS = np.array([[0, 1, 2]], np.int32), np.float32(25)


def _line() -> tuple[MotionGraph, dict[str, MeshSequence]]:
    """One straight take of 1 m with a loop in it."""
    rest = np.random.default_rng(2).normal(size=(5, 3))
    vertices = np.repeat(rest[None], 21, axis=0)
    vertices[:, :, 0] += np.linspace(0, 1, 21)[:, None]
    one = np.zeros(1, np.int32)
    graph = MotionGraph(
        np.array(["a"]), np.array([21], np.int32), one, one, np.array([17], np.int32), np.array([5], np.int32),
        np.array([1], np.int32), np.array([0.01], np.float32), np.zeros(1), np.array([[0.6, 0.0]]),
        np.ones(1, bool), FPS,
    )  # fmt: skip
    return graph, {"a": MeshSequence(vertices.astype(np.float32), FACES, FPS)}


def test_both_solve_the_same_targets() -> None:
    found = target_time(
        *_line(), keys=("a:0 > a:20",), distances=(1.6,), durations=(1.32,), programmes=1, cells=1.0
    )
    row = dict(zip(found.name.tolist(), found.value[0], strict=True))
    assert row["cost difference"] == pytest.approx(0.0, abs=1e-5)
    assert 0 < row["target"] <= row["target max"]
    assert row["speedup"] == pytest.approx(row["programme"] / row["target"])


def test_without_programmes_they_are_not_measured() -> None:
    found = target_time(
        *_line(), keys=("a:0 > a:20",), distances=(1.6,), durations=(1.32,), programmes=0, cells=1.0
    )
    row = dict(zip(found.name.tolist(), found.value[0], strict=True))
    assert np.isnan([row["programme"], row["speedup"], row["cost difference"]]).all()
    assert row["prepare"] > 0
