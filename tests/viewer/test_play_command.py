"""`reperform play` from the command line, by scripted keys and without a display."""

from click.testing import CliRunner

from reperform.viewer.commands.play import command

PIPELINE = """
steps:
  rig: {node: studio.rig}
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
