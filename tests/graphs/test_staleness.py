"""What is in a key and what is not: axes, windows, parameters, files; within one process."""

import numpy as np
import pytest

import reperform

NODES = """
from typing import Annotated, NamedTuple
import numpy as np
from reperform import Axes, Dataset, File, Pair, Pairs, Param, node


class Numbers(NamedTuple):
    values: Annotated[np.ndarray, Axes("frame", "k", dtype="float64")]


class Views(NamedTuple):
    values: Annotated[np.ndarray, Axes("frame", "camera", "k", dtype="float64")]
    place: Annotated[np.ndarray, Axes("camera", dtype="float64")]


class One(NamedTuple):
    value: Annotated[np.ndarray, Axes(dtype="float64")]


@node(over="take")
def numbers(*, count: int = 10, changed: int = -1, seed: float = 0.0) -> Numbers:
    values = np.arange(2.0 * count).reshape(count, 2) + seed
    if changed >= 0:
        values[changed] += 0.5
    return Numbers(values)


@node(over="take")
def views(*, frames: int = 3, cameras: int = 4, moved: int = -1, dark: list[int] = []) -> Views:
    values = np.arange(frames * 8.0)[:, None, None] + 100 * np.arange(cameras)[None, :, None]
    place = np.arange(float(cameras))
    if moved >= 0:
        place[moved] += 0.5
    if dark:
        values[dark[0], dark[1]] = -1.0
    return Views(values[:frames], place)


@node(over="frame", window=(2, 1))
def smooth(numbers: Numbers, *, centre: int) -> Numbers:
    return Numbers(numbers.values.mean(axis=0) + 0 * numbers.values[centre])


@node(over="view")
def seen(views: Views) -> Views:
    return Views(views.values + views.place, views.place)


@node(over="frame")
def per_frame(views: Views) -> Numbers:
    return Numbers(views.values[:, 0])


@node(over="frame")
def plus(numbers: Numbers, *, add: float = 1.0, threads: Annotated[int, Param("1", 1, 8, "", in_key=False)] = 1) -> Numbers:
    return Numbers(numbers.values + add)


@node(over="pair")
def distance(numbers: Pair[Numbers]) -> One:
    return One(np.abs(numbers[0].values.mean() - numbers[1].values.mean()))


@node(over="dataset")
def total(numbers: Dataset[Numbers]) -> One:
    return One(sum(float(np.asarray(product.values).sum()) for product in numbers.values()))


@node(over="dataset")
def widest(distances: Pairs[One]) -> One:
    return One(max(float(one.value) for one in distances.values()))


@node(over="dataset", volatile=True)
def timed(numbers: Dataset[Numbers]) -> One:
    return One(1.0)


@node(over="take")
def read(*, file: Annotated[str, File("text with numbers")] = "") -> Numbers:
    return Numbers(np.loadtxt(file, ndmin=2))
"""


@pytest.fixture
def run(plug_in, tmp_path):
    """Runs a pipeline of the nodes above (`demo.` is filled in): items computed by step."""
    name = plug_in(NODES).name

    def run(text: str, *sets: str, **options):
        path = tmp_path / "p.yaml"
        path.write_text(text.replace("demo.", f"{name}."))
        done = reperform.load(path, sets).run(store=tmp_path / "store", **options)
        return {step: report.computed for step, report in done.report.steps.items()}, done

    return run


SMOOTH = """
steps:
  n: {node: demo.numbers}
  s: {node: demo.smooth, inputs: {numbers: n}}
  p: {node: demo.plus, inputs: {numbers: s}}
"""


def test_window_widens_the_stale_range_by_exactly_the_window(run):
    assert run(SMOOTH)[0] == {"n": 1, "s": 10, "p": 10}
    # frame 4 is seen by items 3 (after 1) .. 6 (before 2)
    assert run(SMOOTH, "n.changed=4")[0] == {"n": 1, "s": 4, "p": 4}
    # at the end the window is clipped
    assert run(SMOOTH, "n.changed=9")[0] == {"n": 1, "s": 2, "p": 2}


def test_one_more_frame(run):
    run(SMOOTH)
    # the last item's window was clipped before; now it has a neighbour
    assert run(SMOOTH, "n.count=11")[0] == {"n": 1, "s": 2, "p": 2}


def test_going_back_is_a_hit(run):
    run(SMOOTH)
    run(SMOOTH, "p.add=3")
    assert run(SMOOTH)[0] == {"n": 0, "s": 0, "p": 0}


def test_windowed_values_are_those_of_a_plain_mean(run):
    _, done = run(SMOOTH)
    values = np.arange(20.0).reshape(10, 2)
    expected = np.stack([values[max(0, k - 2) : k + 2].mean(axis=0) for k in range(10)])
    np.testing.assert_array_equal(np.asarray(done["s"]["take"].values), expected)


TAKES = """
takes: {x: {}, y: {params: {n: {seed: 5}}}}
steps:
  n: {node: demo.numbers}
  d: {node: demo.distance, inputs: {numbers: n}}
  t: {node: demo.total, inputs: {numbers: n}}
"""


def test_one_more_take(run):
    assert run(TAKES)[0] == {"n": 2, "d": 4, "t": 1}
    more = TAKES.replace("y: {params", "z: {params: {n: {seed: 7}}}, y: {params")
    assert run(more)[0] == {"n": 1, "d": 5, "t": 1}


def test_one_take_changed(run):
    run(TAKES)
    assert run(TAKES.replace("seed: 5", "seed: 6"))[0] == {"n": 1, "d": 3, "t": 1}


def test_the_takes_of_a_step_are_all_that_it_sees(run):
    held = TAKES.replace(
        "t: {node: demo.total, inputs: {numbers: n}}",
        """t: {node: demo.total, inputs: {numbers: n}, takes: [x]}
  w: {node: demo.widest, inputs: {distances: d}, takes: [x]}
  a: {node: demo.widest, inputs: {distances: d}}""",
    )
    assert run(held)[0] == {"n": 2, "d": 4, "t": 1, "w": 1, "a": 1}
    done, made = run(held.replace("seed: 5", "seed: 6"))
    assert done == {"n": 1, "d": 3, "t": 0, "w": 0, "a": 1}
    assert float(made["w"].value) == 0 != float(made["a"].value)


VIEWS = """
steps:
  v: {node: demo.views}
  s: {node: demo.seen, inputs: {views: v}}
  f: {node: demo.per_frame, inputs: {views: s}}
"""


def test_a_view_is_an_item(run):
    assert run(VIEWS)[0] == {"v": 1, "s": 12, "f": 3}
    # one camera moved: its three views, and all frames that see all cameras
    assert run(VIEWS, "v.moved=2")[0] == {"v": 1, "s": 3, "f": 3}
    assert run(VIEWS, "v.dark=[1, 3]")[0] == {"v": 1, "s": 1, "f": 1}
    assert run(VIEWS, "v.cameras=5")[0] == {"v": 1, "s": 3, "f": 3}
    assert run(VIEWS, "v.frames=4")[0] == {"v": 1, "s": 4, "f": 1}


def test_volatile_always_runs_and_what_stands_on_it_does_not(run):
    text = """
steps:
  n: {node: demo.numbers}
  t: {node: demo.timed, inputs: {numbers: n}}
"""
    assert run(text)[0] == {"n": 1, "t": 1}
    assert run(text)[0] == {"n": 0, "t": 1}


def test_parameters_out_of_the_key(run):
    run(SMOOTH)
    assert run(SMOOTH, "p.threads=4")[0] == {"n": 0, "s": 0, "p": 0}


def test_file_counts_by_content(run, tmp_path):
    text = "steps:\n  r: {node: demo.read, params: {file: FILE}}\n"
    first, second = tmp_path / "first.txt", tmp_path / "second.txt"
    first.write_text("1 2\n3 4\n")
    assert run(text.replace("FILE", str(first)))[0] == {"r": 1}
    first.touch()
    assert run(text.replace("FILE", str(first)))[0] == {"r": 0}
    second.write_text("1 2\n3 4\n")
    assert run(text.replace("FILE", str(second)))[0] == {"r": 0}
    second.write_text("1 2\n3 5\n")
    assert run(text.replace("FILE", str(second)))[0] == {"r": 1}


def test_batch_size_is_not_in_the_key(run, monkeypatch):
    from reperform.graphs import pace

    monkeypatch.setattr(pace, "BATCH_ITEMS", 1)
    run(SMOOTH)
    monkeypatch.setattr(pace, "BATCH_ITEMS", 512)
    counts, done = run(SMOOTH, "n.changed=4")
    assert counts == {"n": 1, "s": 4, "p": 4}
    digest = done.digest("p", "take")
    # computed in other batches, from nothing: the same digests
    import shutil

    shutil.rmtree(done.url)
    assert run(SMOOTH, "n.changed=4")[1].digest("p", "take") == digest
