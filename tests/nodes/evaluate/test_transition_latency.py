"""Latency of transitions between two circles of poses whose distances are known."""

import numpy as np
import pytest

from reperform.nodes.evaluate.transition_latency import transition_latency
from reperform.nodes.motion_graph.parametric import parametric
from reperform.nodes.products.parametric import ParametricGraph, ParametricSpace

FACES = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]], np.int32)
REST = np.array([[0.1, 0, 0], [0.5, 0.2, 0], [0, 1.1, 0.3], [-0.2, 0.3, 0.4]])


def circling(poses: int, shift: float, seconds: float) -> ParametricSpace:
    """Two inputs whose top goes round once in `poses`, one of them higher; they meet the other space at one pose."""
    angle = 2 * np.pi * (np.arange(poses) / poses + shift)
    vertices = np.repeat(REST[None, None], 2, axis=0).repeat(poses, axis=1)
    vertices[:, :, 2, 0] += 0.3 * np.cos(angle)
    vertices[:, :, 2, 2] += 0.3 * np.sin(angle)
    vertices[1, :, 2, 1] += 0.2
    two = np.array([[0.0], [1.0]])
    return ParametricSpace(
        np.array(["low", "high"]), vertices.astype(np.float32), np.zeros((2, poses, 3)), np.full((2, poses), seconds / poses),
        np.zeros((2, poses, 2), bool), np.zeros((2, poses)), np.asarray(True), np.array(["height"]), np.array(["m"]),
        two * 0.2, two, np.array([[0, 1]], np.int32), np.eye(2), two * 0.2, np.zeros(1), np.full(1, 0.2),
        np.array([2], np.int32), two, np.zeros((1, 2)), np.array([-1, -1], np.int32), np.asarray(False), FACES,
        np.asarray(25, np.float32),
    )  # fmt: skip


@pytest.fixture(scope="module")
def graph() -> ParametricGraph:
    spaces = {"slow": circling(24, 0.0, 2.0), "quick": circling(20, 0.31, 1.0)}
    return parametric(spaces, edges=("slow>quick",), blend="linear", subdivisions=1, velocity_weight=0.0)


def test_searching_is_never_dearer_than_fixed_transitions_and_depth_never_harms(graph):
    measured = transition_latency(graph, edge="slow>quick", draws=12)
    column = dict(zip(measured.name.tolist(), measured.value.T, strict=True))
    cost = {
        name: column[f"shape {name}"] + column[f"latency cost {name}"]
        for name in ("1 fixed", "5 fixed", "10 fixed", "depth 3", "depth 7", "depth 12")
    }
    # a fixed way changes all controls before it leaves, so a trellis of the depth of a run may do all it does
    for less, more in (
        ("depth 12", "depth 7"),
        ("depth 7", "depth 3"),
        ("10 fixed", "5 fixed"),
        ("5 fixed", "1 fixed"),
    ):
        assert (cost[less] <= cost[more] + 1e-9).all()
    assert cost["depth 12"].mean() < cost["10 fixed"].mean()
    assert column["latency cost depth 7"] == pytest.approx(0.45 * 25 * column["latency depth 7"])
    assert (column["time depth 10"] > 0).all()


def test_ratios_are_those_of_the_means(graph):
    measured = transition_latency(graph, edge="slow>quick", draws=6, seed=3)
    mean = dict(zip(measured.name.tolist(), measured.value.mean(axis=0), strict=True))
    assert mean["latency ratio"] == pytest.approx(mean["latency depth 10"] / mean["latency 10 fixed"])
    assert mean["shape ratio"] == pytest.approx(mean["shape depth 10"] / mean["shape 10 fixed"])


def test_an_edge_that_is_not_there_is_told_of(graph):
    with pytest.raises(ValueError, match="no edge quick>slow"):
        transition_latency(graph, edge="quick>slow")
