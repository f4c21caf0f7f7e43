"""Exports are written when they are stale, films beside pictures, and left alone when fresh."""

import pytest

from reperform.graphs.api import load
from reperform.graphs.errors import DefinitionError
from reperform.viewer.exports import write_exports

STEPS = """
steps:
  rig: {node: studio.rig, params: {cameras: 2, width: 64, picture_height: 48}}
  twin: {node: studio.perform, params: {motion: stand, seconds: 0.2}}
  film: {node: studio.film, inputs: {mesh: twin.mesh, texture: twin.texture, cameras: rig}}
exports:
  out/film.mp4: film
  out/rig.png: rig
  out/texture.png: twin.texture
"""


def test_written_once_and_again_when_gone(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.yaml").write_text(STEPS)
    run = load("p.yaml").run(store=tmp_path / "store")
    assert dict(write_exports(run)) == {
        "out/film.mp4": True, "out/rig.png": True, "out/texture.png": True
    }  # fmt: skip
    assert not any(written for _, written in write_exports(run))
    (tmp_path / "out" / "film.mp4").unlink()
    (tmp_path / "out" / "rig.png").write_bytes(b"changed")
    assert {path for path, written in write_exports(run) if written} == {"out/film.mp4", "out/rig.png"}
    assert (tmp_path / "out" / "film.mp4").stat().st_size > 500


def test_one_of_several_items_must_be_chosen(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = STEPS.replace("steps:", "takes: {a: {}, b: {}}\nsteps:").replace(
        "film.mp4: film", "film.mp4: film/c"
    )
    (tmp_path / "p.yaml").write_text(text)
    with pytest.raises(DefinitionError):
        list(write_exports(load("p.yaml").run(store=tmp_path / "store")))


def test_a_film_that_cannot_be_written_is_told(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "out").write_text("a file where a folder must be")
    (tmp_path / "p.yaml").write_text(STEPS)
    with pytest.raises(OSError, match="out"):
        list(write_exports(load("p.yaml").run(store=tmp_path / "store")))
