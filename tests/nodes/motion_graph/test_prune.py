import numpy as np
import pytest

from reperform.nodes.motion_graph.prune import prune
from reperform.nodes.products.motion import MotionGraph


def _graph(rows: list[tuple[int, int, int, int]], core: list[bool]) -> MotionGraph:
    """Takes a..e of 40 frames, transitions (source, m, target, n) of half length 2."""
    source, m, target, n = (np.array(column, np.int32) for column in zip(*rows, strict=True))
    count = len(rows)
    return MotionGraph(
        np.array(list("abcde")), np.full(5, 40, np.int32), source, target, m, n, np.full(count, 2, np.int32),
        np.linspace(0.1, 0.5, count).astype(np.float32), np.zeros(count), np.zeros((count, 2)), np.array(core),
        np.float32(25),
    )  # fmt: skip


def test_what_goes_and_why() -> None:
    rows = [
        (0, 30, 1, 5),  # a > b and back: the core
        (1, 30, 0, 5),
        (1, 20, 2, 10),  # into c, from which nothing leaves
        (3, 10, 0, 8),  # out of d, which nothing enters
        (3, 20, 4, 10),  # between two takes that the core neither reaches nor leads to
    ]
    pruned = prune(_graph(rows, [True, True, False, False, False]))
    assert pruned.graph.takes.tolist() == ["a", "b"]
    assert pruned.graph.source.tolist() == [0, 1]
    assert pruned.graph.target.tolist() == [1, 0]
    assert pruned.graph.core.all()
    told = dict(zip(pruned.report.what.tolist(), pruned.report.why.tolist(), strict=True))
    assert told == {
        "b:20 > c:10": "leads into a dead end",
        "d:10 > a:8": "cannot be come back to",
        "d:20 > e:10": "apart from the core",
        "c": "no transition left",
        "d": "no transition left",
        "e": "no transition left",
    }
    assert pruned.report.cost[0] == pytest.approx(0.3)


def test_nothing_goes_from_a_graph_that_is_its_core() -> None:
    graph = _graph([(0, 30, 1, 5), (1, 30, 0, 5)], [True, True])
    pruned = prune(graph._replace(takes=graph.takes[:2], frames=graph.frames[:2]))
    assert len(pruned.report.what) == 0
    assert pruned.graph.source.tolist() == [0, 1]


def test_without_a_loop_there_is_nothing_to_keep() -> None:
    with pytest.raises(ValueError, match="has no loop"):
        prune(_graph([(0, 30, 1, 5)], [False]))
