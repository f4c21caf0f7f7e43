"""An input that is a list of steps: one product per step, as a dataset."""

from pathlib import Path

import numpy as np
import pytest

from reperform.graphs.errors import DefinitionError
from reperform.graphs.pipeline import read_pipeline

STEPS = """
takes:
  low: {{vars: {{first: 0}}}}
  high: {{vars: {{first: 2}}}}
steps:
  mesh: {{node: capture.mesh_sequence, params: {{file: {file}, first: "${{first}}", count: 2, fps: 25}}}}
  size: {{node: evaluate.volume, inputs: {{mesh: mesh}}}}
  tall: {{node: evaluate.height, inputs: {{mesh: mesh}}}}
  volume: {{node: evaluate.figure, inputs: {{measures: size}}, params: {{figure: volume}}}}
  height: {{node: evaluate.figure, inputs: {{measures: tall}}, params: {{figure: height}}}}
  table: {{node: evaluate.table, inputs: {{figures: {figures}}}}}
"""


@pytest.fixture
def write(tmp_path: Path):
    corners = np.array([[0, 0, 0], [2, 0, 0], [0, 0, 3], [0, 1, 0]], np.float32)
    faces = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]], np.int32)
    growing = corners * np.array([1, 1, 2, 2])[:, None, None]
    np.savez(tmp_path / "solid.npz", vertices=growing.astype(np.float32), faces=faces)

    def at(figures: str) -> Path:
        path = tmp_path / "pipeline.yaml"
        path.write_text(STEPS.format(file=tmp_path / "solid.npz", figures=figures))
        return path

    return at


def test_products_come_in_the_order_of_the_list(write, tmp_path):
    run = read_pipeline(write("[height, volume]")).run(store=str(tmp_path / "store"))
    table = run["table"]
    assert list(np.asarray(table.figure)) == ["height", "volume"]
    assert np.asarray(table.value) == pytest.approx([1.5, (1 + 8) / 2])


def test_the_order_is_part_of_the_key(write, tmp_path):
    first = read_pipeline(write("[height, volume]")).run(store=str(tmp_path / "store"))
    second = read_pipeline(write("[volume, height]")).run(store=str(tmp_path / "store"))
    assert first.report.steps["table"].computed == 1
    assert second.report.steps["table"].computed == 1
    assert second.report.steps["volume"].cached == 1


@pytest.mark.parametrize(
    ("figures", "told"),
    [
        ("[volume, hight]", "no step 'hight'.*height"),
        ("[volume, volume]", "every step once"),
        ("[volume, tall]", "must be Table, but 'tall' gives Measures"),
        ("[]", "names of steps"),
        ("[volume/low]", "names of steps"),
    ],
)
def test_wrong_lists_are_refused_with_their_place(write, figures, told):
    with pytest.raises(DefinitionError, match=rf"pipeline\.yaml:\d+: .*{told}"):
        read_pipeline(write(figures))


def test_a_list_is_refused_where_one_product_is_wanted(write):
    path = write("[volume]")
    path.write_text(path.read_text().replace("{mesh: mesh}", "{mesh: [mesh]}", 1))
    with pytest.raises(DefinitionError, match="one product"):
        read_pipeline(path)


def test_steps_that_give_one_product_per_take_cannot_be_listed(write):
    path = write("[volume]")
    path.write_text(path.read_text().replace("{measures: size}", "{measures: [size, tall]}"))
    with pytest.raises(DefinitionError, match="one product per step, but 'size' gives one per take"):
        read_pipeline(path)
