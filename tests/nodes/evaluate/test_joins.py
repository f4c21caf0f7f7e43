"""Acceleration at joins of motions with known ones."""

import numpy as np
import pytest

from reperform.nodes.evaluate.joins import joins
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation, Provenance

FACES = np.array([[0, 1, 2]], np.int32)
FPS = np.float32(25)


def falling(acceleration: float, frames: int = 30) -> np.ndarray:
    drop = 0.5 * acceleration * (np.arange(frames) / 25.0) ** 2
    return (np.eye(3)[None] + drop[:, None, None] * np.array([0.0, 1.0, 0.0])).astype(np.float32)


def animation(vertices: np.ndarray, blended: list[int]) -> Animation:
    count = len(vertices)
    weight = np.tile(np.float32([1, 0]), (count, 1))
    weight[blended] = 0.5
    two = (count, 2)
    provenance = Provenance(
        np.array(["a"]),
        np.zeros(two, np.int32),
        np.zeros(two, np.int32),
        weight,
        np.zeros(two),
        np.zeros((*two, 2)),
    )
    return Animation(MeshSequence(vertices, FACES, FPS), provenance)


def test_the_ratio_of_two_falls():
    capture = {"a": MeshSequence(falling(2.0), FACES, FPS)}
    found = joins(animation(falling(5.0), [12, 13]), capture)
    assert found.value[0, 0] == pytest.approx(2.5, rel=0.01)


def test_only_joins_count():
    jump = falling(2.0)
    jump[20:] += np.float32(0.1)
    capture = {"a": MeshSequence(falling(2.0), FACES, FPS)}
    assert joins(animation(jump, [8, 9]), capture).value[0, 0] == pytest.approx(1.0, rel=0.01)
    assert joins(animation(jump, [19, 20]), capture).value[0, 0] > 10
    assert np.isnan(joins(animation(jump, []), capture).value[0, 0])


def test_other_meshes_are_refused():
    capture = {"a": MeshSequence(falling(2.0), FACES, np.float32(50))}
    with pytest.raises(ValueError, match="3 at 25 Hz, got 3 at 50 Hz"):
        joins(animation(falling(2.0), [5]), capture)
