"""Threads, worker processes, a cluster, two cold runs: the same digests, whoever computes."""

import sys

import pytest
from distributed import LocalCluster

import reperform

NODES = """
from typing import Annotated, NamedTuple
import numpy as np
from reperform import Axes, Dataset, Pair, Pairs, node


class Numbers(NamedTuple):
    values: Annotated[np.ndarray, Axes("frame", "k", dtype="float64")]
    name: Annotated[np.ndarray, Axes(dtype="str")]


class Some(NamedTuple):
    values: Annotated[np.ndarray, Axes("frame", "k*", dtype="float32")]


class One(NamedTuple):
    value: Annotated[np.ndarray, Axes(dtype="float64")]


@node(over="take")
def source(*, seed: int = 0) -> Numbers:
    return Numbers(np.random.default_rng(seed).normal(size=(9, 300)), np.array(f"take {seed}"))


@node(over="frame", window=(1, 2))
def product(numbers: Numbers, *, centre: int) -> Numbers:
    return Numbers(numbers.values.T[:, centre] @ np.outer(numbers.values.sum(0), numbers.values[0]), numbers.name)


@node(over="frame")
def ragged(numbers: Numbers) -> Some:
    return Some(numbers.values[numbers.values > 0.5].astype(np.float32))


@node(over="pair")
def distance(numbers: Pair[Numbers]) -> One:
    return One(np.linalg.norm(numbers[0].values - numbers[1].values))


@node(over="dataset")
def total(ones: Pairs[One], some: Dataset[Some]) -> One:
    return One(sum(float(one.value) for one in ones.values()) + sum(float(s.values[0].sum()) for s in some.values()))


@node(over="dataset")
def scaled(numbers: Dataset[Numbers]) -> Dataset[Numbers]:
    return {take: Numbers(np.asarray(n.values) / 3, np.asarray(n.name)) for take, n in numbers.items()}
"""
PIPELINE = """
takes: {x: {}, y: {params: {n: {seed: 1}}}}
steps:
  n: {node: demo.source}
  p: {node: demo.product, inputs: {numbers: n}}
  s: {node: demo.scaled, inputs: {numbers: p}}
  r: {node: demo.ragged, inputs: {numbers: s}}
  d: {node: demo.distance, inputs: {numbers: s}}
  t: {node: demo.total, inputs: {ones: d, some: r}}
"""


def test_same_digests_whoever_computes(plug_in, tmp_path):
    made = plug_in(NODES)
    path = tmp_path / "p.yaml"
    path.write_text(PIPELINE.replace("demo.", f"{made.name}."))
    pipeline = reperform.load(path)

    def digests(store: str, **options):
        run = pipeline.run(store=tmp_path / store, **options)
        assert all(step.cached == 0 for step in run.report.steps.values())
        return {
            (step, unit): run.digest(step, unit)
            for step in pipeline.steps
            for unit in pipeline.steps[step].units
        }

    first = digests("first", jobs=1)
    assert digests("again", jobs=3) == first
    assert digests("processes", jobs=2, scheduler="processes") == first
    with LocalCluster(n_workers=1, threads_per_worker=2, dashboard_address=None) as cluster:
        assert digests("cluster", cluster=cluster.scheduler_address) == first


def test_no_cluster_at_the_address(plug_in, tmp_path, monkeypatch):
    from reperform.graphs import executor

    monkeypatch.setattr(executor, "CONNECT_SECONDS", 0.3)
    with pytest.raises(ConnectionError, match="start one with `dask scheduler`"):
        executor.Workers.at("tcp://127.0.0.1:9")


def test_a_library_that_another_batch_is_importing_is_left_alone(monkeypatch):
    from types import ModuleType

    from reperform.graphs.batch import _threads

    for name in ("numba", "cv2"):
        monkeypatch.setitem(sys.modules, name, ModuleType(name))
    with _threads(1):
        pass
