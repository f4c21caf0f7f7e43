"""What goes wrong while running: one item, one step, the disk; nothing that was finished is lost."""

import json
import resource
import subprocess
import sys

import numpy as np
import pytest

import reperform
from reperform.graphs.errors import RunError
from reperform.storage.errors import StoreError

NODES = """
from typing import Annotated, NamedTuple
import numpy as np
from reperform import Axes, Dataset, node


class Numbers(NamedTuple):
    values: Annotated[np.ndarray, Axes("frame", "k", dtype="float64")]


class Odd(NamedTuple):
    values: Annotated[np.ndarray, Axes("frame", "3", dtype="float32")]
    rate: Annotated[np.ndarray, Axes(dtype="float32")]


class One(NamedTuple):
    value: Annotated[np.ndarray, Axes(dtype="float64")]


@node(over="take")
def source(*, count: int = 6, wide: int = 2) -> Numbers:
    rows = np.random.default_rng(3).normal(size=(count, wide))
    rows[:, 0] = np.arange(count)
    return Numbers(rows)


@node(over="frame")
def picky(numbers: Numbers, *, bad: list[int] = []) -> Numbers:
    if int(numbers.values[0]) in bad:
        raise ValueError("the matte is empty: choose another threshold")
    return Numbers(numbers.values + 1)


@node(over="frame")
def wrong(numbers: Numbers, *, how: str = "shape") -> Odd:
    shape = 2 if how == "shape" else 3
    kind = np.complex128 if how == "dtype" else np.float32
    return Odd(np.zeros(shape, kind), np.float32(numbers.values[0] if how == "constant" else 25))


@node(over="take")
def half(numbers: Numbers, *, count: int = 3) -> Numbers:
    return Numbers(numbers.values[:count])


@node(over="frame")
def add(one: Numbers, two: Numbers) -> Numbers:
    return Numbers(one.values + two.values)


@node(over="dataset")
def total(numbers: Dataset[Numbers]) -> One:
    return One(sum(float(np.asarray(product.values).sum()) for product in numbers.values()))
"""
PIPELINE = """
takes: {x: {}, y: {params: {n: {wide: 3}, p: {bad: [2, 4]}}}}
steps:
  n: {node: demo.source}
  p: {node: demo.picky, inputs: {numbers: n}}
  after: {node: demo.picky, inputs: {numbers: p}}
  t: {node: demo.total, inputs: {numbers: p}}
"""


@pytest.fixture
def run(plug_in, tmp_path):
    """Runs a pipeline of the nodes above."""
    name = plug_in(NODES).name

    def run(text, *sets, **options):
        path = tmp_path / "p.yaml"
        path.write_text(text.replace("demo.", f"{name}."))
        return reperform.load(path, sets).run(store=tmp_path / "store", **options)

    return run


def counts(report, step):
    found = report.steps[step]
    return found.computed, found.cached, found.failed, found.skipped


def test_a_failing_item_fails_alone(run):
    with pytest.raises(RunError) as caught:
        run(PIPELINE, keep_going=True, jobs=1)
    told, report = str(caught.value), caught.value.report
    for frame in (2, 4):
        assert f"step 'p/y', frame {frame} (node demo" in told
    assert "the matte is empty: choose another threshold" in told
    assert "rerun only what is missing with: reperform run p" in told
    assert counts(report, "n") == (2, 0, 0, 0)
    assert counts(report, "p") == (10, 0, 2, 0)
    assert counts(report, "after") == (6, 0, 0, 1)
    assert counts(report, "t") == (0, 0, 0, 1)
    # mended: only the two items, and what stands on them
    done = run(PIPELINE.replace("[2, 4]", "[]"), keep_going=True)
    assert counts(done.report, "p")[0] in (2, 6)
    assert counts(done.report, "t") == (1, 0, 0, 0)


def test_without_keep_going_nothing_new_is_started(run):
    with pytest.raises(RunError) as caught:
        run(PIPELINE.replace("x: {}, ", "").replace("[2, 4]", "[0, 1, 2, 3, 4, 5]"), jobs=1)
    report = caught.value.report
    assert 1 <= counts(report, "p")[2] < 6
    assert counts(report, "t") == (0, 0, 0, 1)


@pytest.mark.parametrize(
    ("how", "told"),
    [
        ("shape", r"field 'values' must have axes \(3\), got shape \(2,\)"),
        ("dtype", "field 'values' must be float32, got complex128"),
        (
            "constant",
            "field 'rate' has no frame axis, so it must be the same for every frame, but it differs",
        ),
    ],
)
def test_outputs_are_held_to_their_declaration(run, how, told):
    text = f"steps:\n  n: {{node: demo.source}}\n  w: {{node: demo.wrong, inputs: {{numbers: n}}, params: {{how: {how}}}}}\n"
    with pytest.raises(RunError, match=told):
        run(text)


def test_frame_counts_that_differ(run):
    text = """
steps:
  n: {node: demo.source}
  h: {node: demo.half, inputs: {numbers: n}}
  a: {node: demo.add, inputs: {one: n, two: h}}
"""
    with pytest.raises(RunError, match="same number of frames, but 'one' has 6, 'two' has 3"):
        run(text)
    with pytest.raises(RunError, match="have no frames at all"):
        run(text.replace("one: n", "one: h"), "h.count=0")


def test_exit_status_and_report_of_a_failure(new_plug_in, new_command, tmp_path):
    new_plug_in(tmp_path, NODES)
    (tmp_path / "p.yaml").write_text(PIPELINE)
    call = new_command(tmp_path)
    done = call("run", "p.yaml", "--keep-going", "--json", "report.json", status=1)
    assert "rerun only what is missing with: reperform run p.yaml p" in done.stderr
    assert "Traceback" not in done.stderr
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["steps"]["p"]["failed"] == 2
    done = call("run", "p.yaml", "--set", "p.baad=1", status=2)
    assert "did you mean 'bad'?" in done.stderr
    planned = json.loads(call("plan", "p.yaml", "t", "--json").stdout)["steps"]
    assert planned["p"]["stale"] == 2
    assert planned["p"]["cached"] == 10
    assert "never computed" in planned["t"]["reasons"][0] or "stands on p" in planned["t"]["reasons"][0]


def test_full_disk_loses_nothing(new_plug_in, new_command, tmp_path):
    new_plug_in(tmp_path, NODES)
    (tmp_path / "p.yaml").write_text(
        "steps:\n  n: {node: demo.source}\n  p: {node: demo.picky, inputs: {numbers: n}}\n"
        "  big: {node: demo.source, params: {count: 50, wide: 20000}}\n"
    )
    call = new_command(tmp_path)
    limit = 600_000  # a chunk of `big` is 1 MB
    process = subprocess.run(
        [sys.executable, "-m", "reperform.viewer.cli", "run", "p.yaml"],
        cwd=tmp_path, env=call.env, capture_output=True, text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
    )  # fmt: skip
    assert process.returncode == 1
    assert "cannot write" in process.stderr
    assert "finished items are kept" in process.stderr
    assert not list(tmp_path.glob(".reperform/segments/.writing-*"))
    again = call.computed("p.yaml")
    assert again["big"] == 1
    assert again["n"] + again["p"] <= 7
    done = call("store", "verify")
    assert "all results are as they were written" in done.stdout


def test_damaged_index_says_what_to_do(run, tmp_path):
    run(PIPELINE.replace("[2, 4]", "[]"))
    (tmp_path / "store" / "index.sqlite").write_bytes(b"not a database" * 100)
    for beside in (tmp_path / "store").glob("index.sqlite-*"):
        beside.unlink()
    with pytest.raises(StoreError, match=r"delete index.sqlite"):
        run(PIPELINE)


def test_lazy_products_read_what_is_indexed(run):
    done = run(PIPELINE.replace("[2, 4]", "[]"))
    values = done["n"]["x"].values
    whole = np.asarray(values)
    assert values.shape == whole.shape == (6, 2)
    np.testing.assert_array_equal(values[-1], whole[-1])
    np.testing.assert_array_equal(values[1:4, 1], whole[1:4, 1])
    np.testing.assert_array_equal(values[[0, 5]], whole[[0, 5]])
    np.testing.assert_array_equal(values[..., 0], whole[..., 0])
    both = sum(np.asarray(product.values).sum() for product in done["p"].values())
    assert float(done["t"].value) == pytest.approx(both)
    with pytest.raises(IndexError):
        values[6]
