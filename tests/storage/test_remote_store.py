"""A store on an object store: the same law, through the real S3 protocol and through fsspec's memory."""

import json
import os
import uuid

import fsspec
import numpy as np
import pytest

import reperform
from reperform.storage import remote_index
from reperform.storage.shelf import forget_open_files
from reperform.storage.store import Store
from reperform.storage.upkeep import copy, verify

NODES = """
import time
from typing import Annotated, NamedTuple
import numpy as np
from reperform import Axes, Param, node


class Numbers(NamedTuple):
    values: Annotated[np.ndarray, Axes("frame", "k", dtype="float64")]


@node(over="take")
def source(*, count: int = 4) -> Numbers:
    return Numbers(np.arange(1.0, count + 1)[:, None] ** 2 + np.arange(50.0) / 7)


@node(over="frame")
def a(numbers: Numbers, *, wait: Annotated[float, Param("s", 0, 9, "", in_key=False)] = 0.0) -> Numbers:
    time.sleep(wait)
    return Numbers(numbers.values * 2)


@node(over="frame")
def b(numbers: Numbers, *, add: float = 1.0) -> Numbers:
    return Numbers(numbers.values + add)
"""
PIPELINE = """
steps:
  source: {node: demo.source}
  a: {node: demo.a, inputs: {numbers: source}}
  b: {node: demo.b, inputs: {numbers: a}}
"""


@pytest.fixture(scope="module")
def s3():
    """A server that speaks S3, on this machine."""
    from moto.server import ThreadedMotoServer

    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    given = {
        "AWS_ENDPOINT_URL": f"http://{host}:{port}",
        "AWS_ACCESS_KEY_ID": "test",
        "AWS_SECRET_ACCESS_KEY": "test",
        "AWS_DEFAULT_REGION": "us-east-1",
    }
    before = {name: os.environ.get(name) for name in given}
    os.environ.update(given)
    fsspec.filesystem("s3").mkdir("results")
    yield
    for name, value in before.items():
        os.environ.pop(name) if value is None else os.environ.update({name: value})
    server.stop()


@pytest.fixture(params=["s3", "memory"])
def url(request, tmp_path, monkeypatch):
    """An empty place on an object store, with no local copy of any index."""
    monkeypatch.setattr(remote_index, "replica_folder", lambda: tmp_path / "cache")
    if request.param == "s3":
        request.getfixturevalue("s3")
        return f"s3://results/{uuid.uuid4().hex}"
    return f"memory://{uuid.uuid4().hex}"


@pytest.fixture
def run(plug_in, tmp_path):
    """Runs the pipeline on a store: items computed by step, and the run."""
    name = plug_in(NODES).name
    (tmp_path / "p.yaml").write_text(PIPELINE.replace("demo.", f"{name}."))

    def run(url, *sets):
        done = reperform.load(tmp_path / "p.yaml", sets).run(store=url)
        return [step.computed for step in done.report.steps.values()], done

    return run


def test_the_law_holds_on_an_object_store(url, run, tmp_path, monkeypatch):
    counts, done = run(url)
    assert counts == [1, 4, 4]
    expected = (np.arange(1.0, 5)[:, None] ** 2 + np.arange(50.0) / 7) * 2 + 1
    np.testing.assert_array_equal(np.asarray(done["b"]["take"].values), expected)
    assert run(url)[0] == [0, 0, 0]
    assert run(url, "b.add=2")[0] == [0, 0, 4]
    # another machine, whose local copy of the index is empty
    monkeypatch.setattr(remote_index, "replica_folder", lambda: tmp_path / "elsewhere")
    assert run(url)[0] == [0, 0, 0]


def test_damaged_object_is_noticed_when_read(url, run):
    run(url)
    fs, root = fsspec.core.url_to_fs(url)
    chunk = sorted(path for path in fs.find(f"{root}/segments") if ".a/" in path and "/values/c" in path)[1]
    data = bytearray(fs.cat_file(chunk))
    data[len(data) // 2] ^= 8
    fs.pipe_file(chunk, bytes(data))
    forget_open_files()
    counts, done = run(url, "b.add=3")
    assert counts == [0, 1, 4]
    assert "damaged result of" in done.notes[0]


def test_copies_there_and_back(url, run, tmp_path):
    _, done = run(tmp_path / "local")
    local, remote = Store(tmp_path / "local"), Store(url)
    assert copy(local, remote)[0] > 0
    assert copy(local, remote) == (0, 0)
    back = Store(tmp_path / "back")
    copy(remote, back)
    assert verify(remote) == verify(back) == []
    for store in (local, remote, back):
        store.close()
    for place in (url, tmp_path / "back"):
        counts, again = run(place)
        assert counts == [0, 0, 0]
        assert again.digest("b", "take") == done.digest("b", "take")


def test_compacted_log_tells_the_same(url, run, tmp_path, monkeypatch):
    run(url)
    run(url, "b.add=2")
    store = Store(url)
    store.index.compact()
    fs, root = fsspec.core.url_to_fs(url, use_listings_cache=False)
    assert len(fs.ls(f"{root}/index")) == 1
    assert run(url, "b.add=2")[0] == [0, 0, 0]
    monkeypatch.setattr(remote_index, "replica_folder", lambda: tmp_path / "elsewhere")
    assert run(url)[0] == [0, 0, 0]
    store.close()


def test_claims_of_two_runs_never_overlap(url):
    first, second = Store(url), Store(url)
    keys = [bytes([k]) * 16 for k in range(6)]
    assert first.claim(keys[:4])[0] == set(keys[:4])
    assert second.claim(keys[2:])[0] == set(keys[4:])
    first.index.release(first.owner)
    assert second.claim(keys[2:4])[0] == set(keys[2:4])
    first.close()
    second.close()


def test_two_runs_at_once_on_s3(s3, new_plug_in, new_command, tmp_path):
    new_plug_in(tmp_path, NODES)
    (tmp_path / "p.yaml").write_text(PIPELINE)
    url = f"s3://results/{uuid.uuid4().hex}"
    call = ("run", "p.yaml", "--store", url, "--set", "a.wait=0.3", "--json")
    runs = [new_command(tmp_path).start(*call) for _ in range(2)]
    outs = [run.communicate(timeout=100) for run in runs]
    assert [run.returncode for run in runs] == [0, 0], outs
    steps = [json.loads(out)["steps"] for out, _ in outs]
    for name, items in {"source": 1, "a": 4, "b": 4}.items():
        assert sum(step[name]["computed"] for step in steps) == items
