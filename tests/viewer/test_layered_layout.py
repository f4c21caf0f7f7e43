import itertools

import pytest

from reperform.viewer.layered_layout import layered_layout


def test_sources_stand_left_of_targets_and_nothing_overlaps() -> None:
    nodes = list("abcdefg")
    edges = [("a", "c"), ("b", "c"), ("a", "g"), ("c", "d"), ("c", "e"), ("d", "f"), ("e", "f"), ("f", "g")]
    heights = dict(zip(nodes, [40, 70, 90, 40, 55, 40, 120], strict=True))
    layout = layered_layout(nodes, edges, heights, 20, 10)
    assert all(layout.layer[a] < layout.layer[b] for a, b in edges)
    for a, b in itertools.combinations(nodes, 2):
        if layout.layer[a] == layout.layer[b]:
            room = (heights[a] + heights[b]) / 2 + 20
            assert abs(layout.centre[a] - layout.centre[b]) >= room - 1e-9
    assert len(layout.through["a", "g"]) == layout.layer["g"] - layout.layer["a"] - 1


def test_two_crossed_edges_are_uncrossed() -> None:
    nodes = ["a", "b", "c", "d"]
    layout = layered_layout(nodes, [("a", "d"), ("b", "c")], dict.fromkeys(nodes, 30.0), 10, 10)
    assert (layout.centre["a"] < layout.centre["b"]) == (layout.centre["d"] < layout.centre["c"])


def test_a_cycle_is_refused() -> None:
    with pytest.raises(ValueError, match=r"cycles, got one among b, c$"):
        layered_layout(["a", "b", "c"], [("a", "b"), ("b", "c"), ("c", "b")], dict.fromkeys("abc", 1.0), 1, 1)
