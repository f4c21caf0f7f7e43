from collections.abc import Mapping

import numpy as np
import pytest

from reperform.nodes.motion_graph.surface import surface
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph
from reperform.nodes.similarity.vertex_velocity import vertex_velocity
from reperform.nodes.synthesis.key_frames import key_frames
from reperform.nodes.synthesis.key_frames_ilp import key_frames_ilp

ENDS = {"start": "slow:3", "end": "turn:40"}


@pytest.fixture(scope="module")
def small(meshes: Mapping[str, MeshSequence]) -> MotionGraph:
    similarity = {(a, b): vertex_velocity((meshes[a], meshes[b])) for a in meshes for b in meshes}
    return surface(similarity, meshes, transitions=4)


@pytest.mark.parametrize(("distance", "duration"), [(4.0, 5.0), (5.0, 6.6), (6.5, 8.0), (None, 6.6)])
def test_it_costs_what_the_dynamic_program_costs(
    small: MotionGraph, meshes: Mapping[str, MeshSequence], distance: float | None, duration: float
) -> None:
    asked = {**ENDS, "distance": distance, "duration": duration}
    other = key_frames(small, meshes, **asked, distance_tolerance=0.5, duration_tolerance=0.5)
    path = key_frames_ilp(small, meshes, **asked, distance_tolerance=0.5, duration_tolerance=0.5)
    assert path.cost == pytest.approx(other.cost, abs=1e-5)
    assert path.bound == path.cost
    assert path.bound >= other.bound - 1e-5
    assert path.duration[0] == len(path.provenance.take) / np.float32(25)


def test_through_others_in_order(small: MotionGraph, meshes: Mapping[str, MeshSequence]) -> None:
    asked = {
        "start": "slow:3",
        "via": ("fast:30",),
        "end": "slow:60",
        "duration": 7.0,
        "duration_tolerance": 0.3,
    }
    other = key_frames(small, meshes, **asked)
    assert key_frames_ilp(small, meshes, **asked).cost == pytest.approx(other.cost, abs=1e-5)


def test_what_cannot_be_met_or_counted_is_said(
    small: MotionGraph, meshes: Mapping[str, MeshSequence]
) -> None:
    told = "no walk through slow:3, turn:40 covers 30 m in 4 s .* nearest that can be met is .* widen the tolerances$"
    with pytest.raises(ValueError, match=told):
        key_frames_ilp(small, meshes, **ENDS, distance=30.0, duration=4.0)
    with pytest.raises(ValueError, match="more than 3 loops"):
        key_frames_ilp(small, meshes, **ENDS, duration=8.0, loops=3)
