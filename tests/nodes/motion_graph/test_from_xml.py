"""Graphs written as XML and read again."""

from pathlib import Path

import numpy as np
import pytest

from reperform.nodes.export.export import endings, write
from reperform.nodes.kernels.motion_graph_xml import read_graph_xml
from reperform.nodes.motion_graph.from_xml import from_xml
from reperform.nodes.motion_graph.parametric import parametric
from reperform.nodes.motion_graph.space import space
from reperform.nodes.products.parametric import ParametricGraph, ParametricSpace


@pytest.fixture(scope="module")
def spaces(takes) -> dict[str, ParametricSpace]:
    return {
        "hop": space(*takes, takes=("low", "high"), parameters=("height",), cyclic=False),
        "walk": space(*takes, takes=("slow", "fast")),
        "spare": space(*takes, takes=("slow", "left"), parameters=("turning",)),
    }


@pytest.fixture(scope="module")
def graph(spaces) -> ParametricGraph:
    joined = {name: spaces[name] for name in ("walk", "hop")}
    return parametric(joined, suggest=1.0, subdivisions=0, blend="linear")


def test_a_written_graph_is_read_back_the_same(graph, spaces, tmp_path: Path):
    path = tmp_path / "graph.xml"
    assert ".xml" in endings(ParametricGraph)
    write(graph, path)
    nodes = read_graph_xml(path.read_text())
    assert [[one.meshes for one in node] for node in nodes] == [["slow/", "fast/"], ["low/", "high/"]]
    back = from_xml(spaces, file=str(path), subdivisions=0, blend="linear")
    for name, field in graph._asdict().items():
        np.testing.assert_array_equal(getattr(back, name), field, err_msg=name)


def test_a_sequence_is_told_by_its_folder_on_either_system(spaces, tmp_path: Path):
    path = tmp_path / "graph.xml"
    names = ("/media/actor/fast", r"C:\media\slow"), ("low", "a/high/")
    listed = ["".join(f"<sequence>{one}</sequence>" for one in node) for node in names]
    path.write_text(
        "<nodes>" + "".join(f"<node><sequences>{x}</sequences></node>" for x in listed) + "</nodes>"
    )
    made = from_xml(spaces, file=str(path), edges=("walk>hop", "hop>walk"), subdivisions=0, blend="linear")
    assert list(made.spaces) == ["walk", "hop"]
    assert made.source.tolist() == [0, 1]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("<nodes>\n<node>\n<sequences>\n</node>\n</nodes>", "bad.xml, line 4: must be well-formed XML"),
        ("<nodes>\n<node>\n<edge/>\n</node></nodes>", "bad.xml, line 3: in <node> stands"),
        (
            "<nodes><node><sequences><sequence>slow</sequence></sequences></node></nodes>",
            "node 1: needs a space of the takes slow, given are hop: low high; walk: slow fast",
        ),
        (
            "<nodes>"
            + 2 * "<node><sequences><sequence>low</sequence><sequence>high</sequence></sequences></node>"
            + "</nodes>",
            "node 2: must differ from the others, got the takes of node 1",
        ),
    ],
)
def test_a_file_that_is_no_such_graph_is_refused(spaces, tmp_path: Path, text: str, problem: str):
    path = tmp_path / "bad.xml"
    path.write_text(text)
    with pytest.raises(ValueError, match=problem):
        from_xml(spaces, file=str(path))


def test_a_missing_file_is_named(spaces, tmp_path: Path):
    with pytest.raises(ValueError, match=r"gone\.xml must be a readable XML file"):
        from_xml(spaces, file=str(tmp_path / "gone.xml"))
