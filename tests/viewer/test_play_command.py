"""`reperform play` from the command line, by scripted keys and without a display."""

import pytest
from click.testing import CliRunner

from reperform.graphs.pipeline import read_pipeline
from reperform.viewer.commands.play import command
from reperform.viewer.play_opening import correcting

PIPELINE = """
steps:
  rig: {node: studio.rig}
"""

PLAYED = """
takes: [walk, jog]
steps:
  actor: {node: studio.perform, params: {motion: "${take}"}}
  walk: {node: motion_graph.space, inputs: {meshes: actor.mesh}}
  graph: {node: motion_graph.parametric, inputs: {spaces: [walk]}}
  better: {node: blend.correct_space, inputs: {space: walk}}
"""


def test_a_step_that_cannot_be_played_is_told_of(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.yaml").write_text(PIPELINE)
    done = CliRunner().invoke(
        command, [str(tmp_path / "p.yaml"), "rig", "--screenshot", "out.png", "--store", str(tmp_path / "s")]
    )
    assert done.exit_code != 0
    assert "what can be played is a ParametricGraph" in str(done.exception)


def test_a_window_needs_a_display(tmp_path, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    (tmp_path / "p.yaml").write_text(PIPELINE)
    done = CliRunner().invoke(command, [str(tmp_path / "p.yaml"), "rig", "--store", str(tmp_path / "s")])
    assert "needs a display" in str(done.exception)


def test_hybrid_blending_needs_steps_that_correct(tmp_path):
    (tmp_path / "p.yaml").write_text(PLAYED)
    pipeline = read_pipeline(tmp_path / "p.yaml")
    assert correcting(pipeline, "graph") == ["better"]
    (tmp_path / "q.yaml").write_text(PLAYED[: PLAYED.index("  better")])
    with pytest.raises(ValueError, match="no step corrects the spaces of 'graph', walk"):
        correcting(read_pipeline(tmp_path / "q.yaml"), "graph")
