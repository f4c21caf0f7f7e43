import sys

import numpy as np
import pytest

from reperform.nodes.evaluate.target_time import target_time
from reperform.nodes.kernels.walk_moves import Moves, Targets, Walk
from reperform.nodes.kernels.walk_programme import Pieces, solve_programme
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph

timing = sys.modules[target_time.__module__]
FACES, FPS = np.array([[0, 1, 2]], np.int32), np.float32(25)


def _line() -> tuple[MotionGraph, dict[str, MeshSequence]]:
    """One straight take of 1 m with a loop in it."""
    rest = np.random.default_rng(2).normal(size=(5, 3))
    vertices = np.repeat(rest[None], 21, axis=0)
    vertices[:, :, 0] += np.linspace(0, 1, 21)[:, None]
    one = np.zeros(1, np.int32)
    graph = MotionGraph(
        np.array(["a"]), np.array([21], np.int32), one, one, np.array([17], np.int32), np.array([5], np.int32),
        np.array([1], np.int32), np.array([0.01], np.float32), np.zeros(1), np.array([[0.6, 0.0]]),
        np.ones(1, bool), FPS,
    )  # fmt: skip
    return graph, {"a": MeshSequence(vertices.astype(np.float32), FACES, FPS)}


def test_both_solve_the_same_targets() -> None:
    # a loop is 0.6 m in 14 steps: the first target is met by one, the last by none
    found = target_time(
        *_line(), keys=("a:0 > a:20",), distances=(1.6, 2.5), durations=(1.4, 2.6), programmes=4, cells=1.0,
    )  # fmt: skip
    row = dict(zip(found.name.tolist(), found.value[0], strict=True))
    assert row["proved"] == 1.0
    assert row["cost difference"] == pytest.approx(0.0, abs=1e-6)
    assert 0 < row["target"] <= row["target max"]
    assert row["programme"] > 0
    assert 1 < row["speedup"] < np.inf


def test_what_the_programme_does_not_prove_counts_neither_way(monkeypatch: pytest.MonkeyPatch) -> None:
    solved: list[float] = []

    def slow(moves: Moves, pieces: Pieces, targets: Targets, seconds: float) -> Walk | None:
        solved.append(targets.steps)
        if len(solved) > 1:
            raise TimeoutError
        found = solve_programme(moves, pieces, targets)
        assert found is not None
        return found._replace(cost=found.cost - 0.25)

    monkeypatch.setattr(timing, "solve_programme", slow)
    asked = {"keys": ("a:0 > a:20",), "distances": (1.6,), "durations": (1.4, 1.44), "cells": 1.0}
    found = target_time(*_line(), **asked, programmes=2)
    row = dict(zip(found.name.tolist(), found.value[0], strict=True))
    assert len(solved) == 2
    assert row["proved"] == 0.5
    assert row["cost difference"] == pytest.approx(0.25, abs=1e-6)
    # no optimum at all
    found = target_time(*_line(), **asked, programmes=2)
    row = dict(zip(found.name.tolist(), found.value[0], strict=True))
    assert row["proved"] == 0.0
    assert np.isnan([row["programme"], row["speedup"], row["cost difference"]]).all()


def test_a_motion_that_one_alone_finds_is_no_agreement(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(timing, "solve_programme", lambda *_: None)
    found = target_time(
        *_line(), keys=("a:0 > a:20",), distances=(1.6,), durations=(1.4,), programmes=1, cells=1.0
    )
    row = dict(zip(found.name.tolist(), found.value[0], strict=True))
    assert row["cost difference"] == np.inf


def test_without_programmes_they_are_not_measured() -> None:
    found = target_time(
        *_line(), keys=("a:0 > a:20",), distances=(1.6,), durations=(1.32,), programmes=0, cells=1.0
    )
    row = dict(zip(found.name.tolist(), found.value[0], strict=True))
    assert np.isnan([row["programme"], row["proved"], row["speedup"], row["cost difference"]]).all()
    assert row["prepare"] > 0
