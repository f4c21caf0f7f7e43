"""The cache law: what an edit, damage, a kill or a second run makes stale, and what not."""

import contextlib
import json
import os
import shutil
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import pytest

NODES = '''
import time
from typing import Annotated, NamedTuple

import numpy as np

from reperform import Axes, Param, node


class Numbers(NamedTuple):
    """Numbers, frame by frame."""

    values: Annotated[np.ndarray, Axes("frame", "k", dtype="float64")]


@node(over="take")
def source(*, count: int = 4) -> Numbers:
    """Squares."""
    return Numbers(np.arange(1.0, count + 1)[:, None] ** 2 + np.arange(50.0) / 7)


def doubled(x):
    return 2.0 * x


@node(over="frame")
def a(numbers: Numbers, *, wait: Annotated[float, Param("s", 0, 9, "time it takes", in_key=False)] = 0.0) -> Numbers:
    """Twice, and one more."""
    time.sleep(wait)
    return Numbers(doubled(numbers.values) + 1.0)


@node(over="frame")
def b(numbers: Numbers, *, add: float = 1.0, wait: Annotated[float, Param("s", 0, 9, "", in_key=False)] = 0.0) -> Numbers:
    """Something added."""
    time.sleep(wait)
    return Numbers(numbers.values + add)
'''
PIPELINE = """
steps:
  source: {node: demo.source}
  a: {node: demo.a, inputs: {numbers: source}}
  b: {node: demo.b, inputs: {numbers: a}}
"""


@pytest.fixture(scope="module")
def finished(tmp_path_factory, new_plug_in, new_command):
    """A folder with plug-in, pipeline and the store of a finished run."""
    folder = tmp_path_factory.mktemp("finished")
    new_plug_in(folder, NODES)
    (folder / "p.yaml").write_text(PIPELINE)
    assert new_command(folder).computed("p.yaml") == {"source": 1, "a": 4, "b": 4}
    return folder


@pytest.fixture
def place(finished, tmp_path):
    """A copy of it, files with their times."""
    return shutil.copytree(finished, tmp_path / "place")


@pytest.mark.parametrize(
    ("old", "new", "stale"),
    [
        ("time.sleep(wait)\n    return Numbers(doubled", "# asleep\n    time.sleep( wait )\n    return Numbers(doubled", (0, 0)),
        ('"""Twice, and one more."""', '"""Doubled."""', (0, 0)),
        ("doubled(numbers.values) + 1.0", "1.0 + doubled(numbers.values)", (4, 0)),
        ("return 2.0 * x", "return 3.0 * x", (4, 4)),
        ("add: float = 1.0", "add: float = 2.0", (0, 4)),
    ],
    ids=["comment", "docstring", "same values", "helper", "default"],
)  # fmt: skip
def test_edit_of_code(place, new_plug_in, new_command, old, new, stale):
    module = place / "demo_nodes.py"
    assert module.read_text().count(old) == 1
    module.write_text(module.read_text().replace(old, new))
    assert new_command(place).computed("p.yaml") == {"source": 0, "a": stale[0], "b": stale[1]}


def chunks(place: Path, node: str) -> list[Path]:
    found = sorted(place.glob(f".reperform/segments/demo.{node}/*/values/c*"))
    assert len(found) == 4
    return found


def flip(path: Path) -> None:
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 0b00001000
    path.write_bytes(data)


@pytest.mark.parametrize(
    "damage",
    [
        flip,
        lambda path: path.write_bytes(path.read_bytes()[: path.stat().st_size // 2]),
        Path.unlink,
    ],
    ids=["bit flipped", "cut in half", "deleted"],
)
def test_damage_is_noticed_and_made_good(place, new_command, damage):
    damage(chunks(place, "a")[2])
    done = new_command(place)("run", "p.yaml", "--json")
    assert "damaged result of demo.a: 1 item(s)" in done.stderr
    assert '"computed": 1' in done.stdout  # one item of a
    assert new_command(place).computed("p.yaml") == {"source": 0, "a": 0, "b": 0}


def test_damage_behind_the_clock_is_noticed_when_read(place, new_command):
    chunk = chunks(place, "a")[1]
    state = chunk.stat()
    flip(chunk)
    os.utime(chunk, ns=(state.st_atime_ns, state.st_mtime_ns))
    assert new_command(place).computed("p.yaml", "--set", "b.add=5") == {"source": 0, "a": 1, "b": 4}


def test_lost_manifest_is_made_again(place, new_command):
    for manifest in place.glob(".reperform/manifests/*"):
        manifest.write_bytes(manifest.read_bytes()[:40])
    done = new_command(place).computed("p.yaml", "--set", "b.add=5")
    assert done == {"source": 0, "a": 0, "b": 4}


def results(place: Path) -> int:
    """Results in the index; 0 while there is none."""
    file = place / ".reperform" / "index.sqlite"
    if not file.exists():
        return 0
    with contextlib.closing(sqlite3.connect(file, timeout=30)) as index:
        try:
            return index.execute("SELECT COUNT(*) FROM results").fetchone()[0]
        except sqlite3.OperationalError:
            return 0


def test_killed_and_resumed(place, new_command):
    shutil.rmtree(place / ".reperform")
    process = new_command(place).start(
        "run", "p.yaml", "--set", "a.wait=0.4", "--set", "b.wait=0.4", "--jobs", "1"
    )
    try:
        deadline = time.monotonic() + 60
        while results(place) < 3 and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.05)
    finally:
        process.kill()
        process.communicate()
    kept = results(place)
    assert 3 <= kept < 9
    again = new_command(place).computed("p.yaml")
    assert sum(again.values()) == 9 - kept


def test_two_runs_at_once_share_the_work(place, new_command):
    shutil.rmtree(place / ".reperform")
    slow = ("run", "p.yaml", "--set", "a.wait=0.3", "--set", "b.wait=0.3", "--json")
    runs = [new_command(place).start(*slow) for _ in range(2)]
    outs = [run.communicate(timeout=100) for run in runs]
    assert [run.returncode for run in runs] == [0, 0], outs
    steps = [json.loads(out)["steps"] for out, _ in outs]
    for name, items in {"source": 1, "a": 4, "b": 4}.items():
        assert sum(step[name]["computed"] for step in steps) == items
        assert all(step[name]["computed"] + step[name]["cached"] == items for step in steps)


def test_nothing_to_do_imports_nothing_heavy(place, new_command):
    script = (
        "import sys; from reperform.viewer.cli import main\n"
        "main(['run', 'p.yaml'], standalone_mode=False)\n"
        "heavy = {'numpy', 'zarr', 'numba', 'scipy', 'cv2', 'dask', 'open3d', 'pyvista', 'rich', 'demo_nodes'}\n"
        "print('loaded:', sorted(heavy & set(sys.modules)))"
    )
    new_command(place)("run", "p.yaml")  # reads the catalogue anew if some source is newer
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=place, env=new_command(place).env, capture_output=True, text=True
    )
    assert "0 computed, 9 cached" in done.stdout, done.stderr
    assert "loaded: []" in done.stdout
