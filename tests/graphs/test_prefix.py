"""Pipelines included under prefixes."""

from pathlib import Path

import numpy as np
import pytest

from reperform.graphs.errors import DefinitionError
from reperform.graphs.pipeline import read_pipeline

INNER = """
vars: {rate: 20, size: 1.0}
takes:
  TAKE-a: {vars: {first: 0}}
  TAKE-b: {vars: {first: 1, size: 3.0}, params: {mesh: {count: 1}}}
steps:
  mesh:
    node: capture.mesh_sequence
    params: {file: FILE, first: "${first}", count: 2, fps: "${rate}", scale: "${size}"}
  tall: {node: evaluate.height, inputs: {mesh: mesh}}
exports: {"TAKE.npz": mesh/TAKE-a}
"""
OUTER = """
include:
  - {pipeline: one.yaml, as: first}
  - {pipeline: two.yaml, as: second, vars: {rate: 40}}
steps:
  height: {node: evaluate.figure, inputs: {measures: second_tall}, params: {figure: height, statistic: sum}}
"""


@pytest.fixture
def outer(tmp_path: Path) -> Path:
    corners = np.array([[0, 0, 0], [2, 0, 0], [0, 0, 3], [0, 1, 0]], np.float32)
    faces = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]], np.int32)
    np.savez(tmp_path / "solid.npz", vertices=corners * np.ones((3, 1, 1), np.float32), faces=faces)
    inner = INNER.replace("FILE", str(tmp_path / "solid.npz"))
    (tmp_path / "one.yaml").write_text(inner.replace("TAKE", "x"))
    (tmp_path / "two.yaml").write_text(inner.replace("TAKE", "y"))
    path = tmp_path / "outer.yaml"
    path.write_text(OUTER)
    return path


def test_steps_and_variables_carry_the_prefix_and_keep_their_takes(outer):
    pipeline = read_pipeline(outer)
    assert list(pipeline.steps) == ["first_mesh", "first_tall", "second_mesh", "second_tall", "height"]
    assert pipeline.takes == ("x-a", "x-b", "y-a", "y-b")
    assert pipeline.steps["first_mesh"].units == ("x-a", "x-b")
    assert pipeline.steps["second_tall"].inputs["mesh"].step == "second_mesh"
    rates = {name: pipeline.steps[f"{name}_mesh"].parameters(f"{take}-a")["fps"] for name, take in
             (("first", "x"), ("second", "y"))}  # fmt: skip
    assert rates == {"first": 20.0, "second": 40.0}
    assert pipeline.exports["y.npz"].step == "second_mesh"


def test_a_take_still_overrides_variables_and_parameters(outer):
    step = read_pipeline(outer).steps["second_mesh"]
    assert (step.parameters("y-a")["scale"], step.parameters("y-a")["count"]) == (1.0, 2)
    assert (step.parameters("y-b")["scale"], step.parameters("y-b")["count"]) == (3.0, 1)


def test_variables_are_set_by_their_prefixed_name(outer):
    pipeline = read_pipeline(outer, ["first_rate=5", "second_mesh.count=1"])
    assert pipeline.steps["first_mesh"].parameters("x-a")["fps"] == 5.0
    assert pipeline.steps["second_mesh"].parameters("y-a")["count"] == 1


def test_a_new_step_sees_the_takes_of_its_inputs_only(outer, tmp_path):
    run = read_pipeline(outer).run(store=str(tmp_path / "store"))
    assert np.asarray(run["height"].value) == pytest.approx([1 + 1 + 3])


def test_a_prefix_is_in_no_key(outer, tmp_path):
    alone = read_pipeline(tmp_path / "one.yaml").run(store=str(tmp_path / "store"))
    both = read_pipeline(outer).run(store=str(tmp_path / "store"), steps=["first_tall"])
    assert alone.report.steps["mesh"].computed == 2
    assert both.report.steps["first_mesh"].computed == both.report.steps["first_tall"].computed == 0


def test_takes_of_one_name_are_refused(outer, tmp_path):
    (tmp_path / "two.yaml").write_text((tmp_path / "one.yaml").read_text())
    with pytest.raises(DefinitionError, match=r"outer\.yaml:4: .*take 'x-a'"):
        read_pipeline(outer)


def test_errors_point_into_the_included_file(outer, tmp_path):
    two = tmp_path / "two.yaml"
    two.write_text(two.read_text().replace("scale:", "scail:"))
    with pytest.raises(DefinitionError, match=r"two\.yaml:9: .*scail.*scale"):
        read_pipeline(outer)


@pytest.mark.parametrize("prefix", ["a-b", "1st", '""'])
def test_a_prefix_is_a_name(outer, prefix):
    outer.write_text(outer.read_text().replace("as: second", f"as: {prefix}"))
    with pytest.raises(DefinitionError, match="letters, digits and _"):
        read_pipeline(outer)
