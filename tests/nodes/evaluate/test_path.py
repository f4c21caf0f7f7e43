"""Errors of a directed motion, promised and measured."""

import numpy as np
import pytest

from reperform.nodes.evaluate.path import path
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation, MotionPath, Provenance

FACES = np.array([[0, 1, 2]], np.int32)


def motion(frames: int, step: float, distance, duration, played: int | None = None):
    """A triangle that goes straight on along (0.6, 0.8), and the path that says so."""
    along = step * np.arange(played or frames)[:, None, None] * np.array([0.6, 0, 0.8])
    bob = 0.1 * np.sin(np.arange(played or frames))[:, None, None] * np.array([0, 1, 0])
    vertices = np.array([[0, 0, 0], [0.3, 1, 0], [0, 0.5, 0.2]]) + along + bob
    two = (frames, 2)
    provenance = Provenance(
        np.array(["walk"]), np.zeros(two, np.int32), np.zeros(two, np.int32), np.ones(two, np.float32),
        np.zeros(two), np.zeros((*two, 2)),
    )  # fmt: skip
    fps = np.float32(20)
    way = MotionPath(
        provenance, np.zeros(0, np.int32), np.float32(distance), np.float32(0), np.float32(duration),
        np.float32(0), np.float32(0), fps,
    )  # fmt: skip
    return way, Animation(MeshSequence(vertices.astype(np.float32), FACES, fps), provenance)


def value(found, name):
    return found.value[0, list(found.name).index(name)]


def test_the_larger_of_promised_and_measured_error_counts():
    found = path(*motion(41, 0.05, distance=[2.01, 2.03], duration=[2.05, 2.0]))
    assert value(found, "measured distance") == pytest.approx(2.0, abs=1e-5)
    assert value(found, "distance") == pytest.approx(0.03, abs=1e-5)
    assert value(found, "duration") == pytest.approx(0.05, abs=1e-5)
    assert value(found, "displacement") == pytest.approx(2.0, abs=1e-5)
    promised_worse = path(*motion(41, 0.05, distance=[2.1, 2.0], duration=[2.3, 2.05]))
    assert value(promised_worse, "distance") == pytest.approx(0.1, abs=1e-5)
    assert value(promised_worse, "duration") == pytest.approx(0.25, abs=1e-5)


def test_what_was_not_asked_is_not_measured():
    found = path(*motion(21, 0.05, distance=[1.0, np.nan], duration=[1.05, 1.0]))
    assert np.isnan(value(found, "distance"))
    assert value(found, "duration") == pytest.approx(0.05, abs=1e-6)


def test_another_animation_is_refused():
    with pytest.raises(ValueError, match="41 frames, got 40"):
        path(*motion(41, 0.05, [2, 2], [2, 2], played=40))
