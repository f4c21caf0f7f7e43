"""Latency of transitions between two circles of poses whose distances are known."""

import pytest

from reperform.nodes.evaluate.transition_latency import transition_latency
from reperform.nodes.motion_graph.parametric import parametric
from reperform.nodes.products.parametric import ParametricGraph


@pytest.fixture(scope="module")
def graph(circling) -> ParametricGraph:
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
    assert column["latency cost depth 7"] == pytest.approx(0.38 * 25 * column["latency depth 7"])
    assert (column["time depth 10"] > 0).all()


def test_ratios_are_those_of_the_means(graph):
    measured = transition_latency(graph, edge="slow>quick", draws=6, seed=3)
    mean = dict(zip(measured.name.tolist(), measured.value.mean(axis=0), strict=True))
    assert mean["latency ratio"] == pytest.approx(mean["latency depth 10"] / mean["latency 10 fixed"])
    assert mean["shape ratio"] == pytest.approx(mean["shape depth 10"] / mean["shape 10 fixed"])


def test_an_edge_that_is_not_there_is_told_of(graph):
    with pytest.raises(ValueError, match="no edge quick>slow"):
        transition_latency(graph, edge="quick>slow")
