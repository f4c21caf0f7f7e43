import numpy as np
import pytest

from reperform.nodes.evaluate.curve_search import curve_search
from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.motion_graph.essential import essential
from reperform.nodes.motion_graph.pose_transitions import pose_transitions
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.similarity.vertex_velocity import vertex_velocity

RANDOM = np.random.default_rng(2)
BODY = RANDOM.normal(size=(9, 3)) * (0.2, 0.5, 0.3)
FACES = np.array([(0, 1, 2), (2, 3, 4), (4, 5, 6), (6, 7, 8)], np.int32)


def take(frames, turn, phase):
    out, place, heading = [], np.zeros(2), 0.3
    for k in range(frames):
        swung = BODY + 0.1 * np.sin(0.6 * k + phase) * BODY[:, [1, 2, 0]]
        out.append(apply(swung, Placement(heading, place)))
        place = place + 0.06 * np.array([np.sin(heading), np.cos(heading)])
        heading += turn
    return MeshSequence(np.array(out, np.float32), FACES, np.float32(25))


@pytest.fixture(scope="module")
def database():
    meshes = {"ahead": take(16, 0.0, 0.0), "left": take(15, 0.06, 1.0)}
    likeness = {(a, b): vertex_velocity((meshes[a], meshes[b])) for a in meshes for b in meshes}
    pairs = {
        (a, b): pose_transitions(
            likeness[a, b], (meshes[a], meshes[b]), alpha=0.05, shortest=0.2, longest=0.3
        )
        for a in meshes
        for b in meshes
    }
    return essential(pairs), likeness, meshes


def test_small_problems_are_solved_to_the_optimum_and_depth_first_is_no_cheaper(database):
    out = curve_search(
        *database,
        curve=((0, 0), (0.1, 0.5), (0.4, 0.8)),
        distance_weight=1.0,
        patience=20.0,
        small=3,
        length=0.4,
        beam=50,
    )
    values = dict(zip(out.name.tolist(), out.value[0], strict=True))
    assert values["proved"] == 1.0
    assert 0.0 <= values["gap"] < 0.02
    assert values["cost ratio"] <= 1.02
    assert values["speedup"] > 0
