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


CURVE = ((0, 0), (0.1, 0.5), (0.4, 0.8))


def column(out, name):
    return out.value[:, out.name.tolist().index(name)]


def test_small_problems_are_solved_to_the_optimum_and_depth_first_is_no_cheaper(database):
    out = curve_search(
        *database, curve=CURVE, distance_weight=1.0, patience=20.0, curves=2, way=1.2, small=3, length=0.4
    )
    assert out.value.shape == (1 + 2 + 3, 6)
    assert (column(out, "proved")[3:] == 1.0).all()
    assert (column(out, "gap")[3:] >= 0.0).all()
    assert (column(out, "gap")[3:] < 0.02).all()
    assert np.isnan(column(out, "gap")[:3]).all()
    assert (column(out, "speedup")[:3] > 0).all()
    # it is cut off, or it got as cheap and is told so
    reached, ratio = column(out, "reached")[:3], column(out, "cost ratio")[:3]
    assert ((reached == 1.0) == (ratio >= 1.0)).all()
    assert (column(out, "speedup")[:3][reached == 0.0] >= 20.0).all()


def test_a_search_that_may_follow_one_walk_only_shows_its_gap(database):
    few, many = (
        curve_search(
            *database,
            curve=CURVE,
            distance_weight=1.0,
            patience=1.0,
            curves=0,
            small=6,
            length=0.5,
            beam=beam,
        )
        for beam in (1, 1000)
    )
    assert np.nanmax(column(few, "gap")) > np.nanmax(column(many, "gap"))


def test_problems_that_could_not_be_proved_are_told(database):
    out = curve_search(
        *database, curve=CURVE, distance_weight=1.0, patience=1.0, curves=0, small=3, length=0.4, most=1
    )
    assert (column(out, "proved")[1:] == 0.0).all()
    assert np.isnan(column(out, "gap")[1:]).all()
