"""Exports are written when they are stale, films beside pictures, and left alone when fresh."""

import numpy as np
import pytest

from reperform.graphs.api import load
from reperform.graphs.errors import DefinitionError
from reperform.viewer.exports import write_exports

STEPS = """
steps:
  rig: {node: studio.rig, params: {cameras: 2, width: 64, picture_height: 48}}
  mesh: {node: capture.mesh_sequence, params: {file: mesh.npz, fps: 25}}
  path: {node: texture.orbit, inputs: {mesh: mesh}, params: {width: 64, picture_height: 48}}
  film: {node: texture.shade, inputs: {mesh: mesh, camera: path}}
exports:
  out/film.mp4: film/take
  out/rig.png: rig
  out/mesh.npz: mesh/take
"""


@pytest.fixture
def pipeline(tmp_path, monkeypatch):
    random = np.random.default_rng(1)
    points = random.random((4, 3, 3)) + [0, 0.5, 0]
    np.savez(tmp_path / "mesh.npz", vertices=points, faces=np.array([[0, 1, 2]]))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.yaml").write_text(STEPS)
    return tmp_path / "p.yaml"


def test_written_once_and_again_when_gone(pipeline, tmp_path):
    run = load("p.yaml").run(store=tmp_path / "store")
    assert dict(write_exports(run)) == {
        "out/film.mp4": True, "out/rig.png": True, "out/mesh.npz": True
    }  # fmt: skip
    assert not any(written for _, written in write_exports(run))
    (tmp_path / "out" / "film.mp4").unlink()
    (tmp_path / "out" / "rig.png").write_bytes(b"changed")
    assert {path for path, written in write_exports(run) if written} == {"out/film.mp4", "out/rig.png"}
    assert (tmp_path / "out" / "film.mp4").stat().st_size > 500


def test_the_item_must_be_one_there_is(pipeline, tmp_path):
    text = STEPS.replace("film/take", "film/c")
    pipeline.write_text(text)
    with pytest.raises(DefinitionError, match="film"):
        list(write_exports(load("p.yaml").run(store=tmp_path / "store")))


def test_a_film_that_cannot_be_written_is_told(pipeline, tmp_path):
    (tmp_path / "out").write_text("a file where a folder must be")
    with pytest.raises(OSError, match="out"):
        list(write_exports(load("p.yaml").run(store=tmp_path / "store")))
