import pytest

from reperform.nodes.kernels.motion_graph_xml import (
    GraphFileError,
    SequenceFiles,
    read_graph_xml,
    write_graph_xml,
)

# 004 fig B.1, with the second node shortened and turning
THESIS = """<?xml version="1.0"?>
<nodes>
  <node>
    <sequences>
      <sequence>/media/seq_14_24_43_walk/</sequence>
      <sequence>/media/seq_14_38_07_jog2/</sequence>
    </sequences>
    <offsets>
      <offset>/media/seq_14_24_43_walk/offsets.txt</offset>
      <offset>/media/seq_14_38_07_jog2/offsets.txt</offset>
    </offsets>
    <rotations>
      <rotation>NO</rotation>
      <rotation>/media/jog2 &amp; more/rotations.txt</rotation>
    </rotations>
  </node>
  <node>
    <sequences>
      <sequence>/media/seq_15_36_08_shortJump/</sequence>
    </sequences>
  </node>
</nodes>
"""


def test_the_figure_of_the_thesis_is_read():
    walk, jump = read_graph_xml(THESIS)
    assert walk == (
        SequenceFiles("/media/seq_14_24_43_walk/", "/media/seq_14_24_43_walk/offsets.txt", None),
        SequenceFiles(
            "/media/seq_14_38_07_jog2/",
            "/media/seq_14_38_07_jog2/offsets.txt",
            "/media/jog2 & more/rotations.txt",
        ),
    )
    assert jump == (SequenceFiles("/media/seq_15_36_08_shortJump/", "", None),)


def test_written_and_read_is_the_same():
    graph = read_graph_xml(THESIS)
    written = write_graph_xml(graph)
    assert read_graph_xml(written) == graph
    assert write_graph_xml(read_graph_xml(written)) == written


@pytest.mark.parametrize(
    ("old", "new", "line", "says"),
    [
        ("</offsets>", "</ofsets>", 11, "well-formed"),
        ("<sequences>", "<sequenses>", 4, "got <sequenses>"),
        ("      <offset>/media/seq_14_38_07_jog2/offsets.txt</offset>\n", "", 3, "as many offsets as sequences, 2, got 1"),
        ("/media/seq_15_36_08_shortJump/", " ", 19, "<sequence> must name a file"),
        ("<rotations>", "<offsets/><rotations>", 12, "one <offsets>"),
        ("  <node>\n    <sequences>", "  <node>stray\n    <sequences>", 4, "<node> holds tags only"),
    ],
)  # fmt: skip
def test_what_is_malformed_is_told_with_its_line(old, new, line, says):
    text = THESIS.replace(old, new, 1)
    with pytest.raises(GraphFileError, match=says) as raised:
        read_graph_xml(text, "fig.xml")
    assert str(raised.value).startswith(f"fig.xml, line {line}:")


@pytest.mark.parametrize("text", ["", "<nodes/>", "<nodes><node/></nodes>"])
def test_a_graph_of_nothing_is_refused(text):
    with pytest.raises(GraphFileError, match="line 1"):
        read_graph_xml(text)


def test_half_of_the_offsets_cannot_be_written():
    with pytest.raises(GraphFileError, match="some only"):
        write_graph_xml(((SequenceFiles("a", "b"), SequenceFiles("c")),))
