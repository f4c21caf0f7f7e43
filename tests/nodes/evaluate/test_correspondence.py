"""Correspondence errors of alignments whose faults are known."""

import numpy as np
import pytest
import trimesh

from reperform.nodes.evaluate.correspondence import correspondence
from reperform.nodes.products.aligned import AlignedSequence
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.performance import SkeletonSequence

FPS = np.float32(25)
NAMES = np.array(["hips", "left_thigh", "left_foot", "right_thigh", "right_foot"])
PARENTS = np.array([-1, 0, 1, 0, 3], np.int32)


def scene(frames: int, stride: float):
    """Two unequal legs that swing against each other: vertices (frame, V, 3), faces, joints (frame, J, 3)."""
    left = trimesh.creation.icosphere(2)
    right = trimesh.creation.icosphere(2)
    vertices, joints = [], []
    for t in range(frames):
        swing = stride * np.sin(0.9 * t + 0.4)
        a = left.vertices * [0.07, 0.42, 0.08] + [0.11, 0.45, swing]
        b = right.vertices * [0.08, 0.4, 0.07] + [-0.12, 0.44, -swing]
        vertices.append(np.concatenate([a, b]) + [0, 0, 0.05 * t])
        places = [
            [0, 0.95, 0],
            [0.11, 0.85, swing],
            [0.11, 0.05, swing],
            [-0.12, 0.84, -swing],
            [-0.12, 0.05, -swing],
        ]
        joints.append(np.array(places) + [0, 0, 0.05 * t])
    faces = np.concatenate([left.faces, right.faces + len(left.vertices)]).astype(np.int32)
    return np.array(vertices, np.float32), faces, np.array(joints, np.float32)


def sequence(vertices, faces) -> MeshSequence:
    return MeshSequence(vertices.astype(np.float32), faces, FPS)


def aligned(vertices, faces, take="walk", frame=1) -> AlignedSequence:
    still = np.zeros(len(vertices), np.float32)
    return AlignedSequence(
        sequence(vertices, faces), still, still, still == 0, np.array(take), np.array(frame, np.int32)
    )


@pytest.fixture(scope="module")
def world():
    takes = {"walk": scene(5, 0.2), "jog": scene(4, 0.35)}
    truth = {name: sequence(v, f) for name, (v, f, _) in takes.items()}
    bones = {name: SkeletonSequence(j, PARENTS, NAMES, FPS) for name, (_, _, j) in takes.items()}
    return truth, bones


def test_a_perfect_alignment_has_no_error_and_the_root_frame_is_not_measured(world):
    truth, bones = world
    found = correspondence({k: aligned(t.vertices, t.faces) for k, t in truth.items()}, truth, bones)
    assert np.isnan(found["walk"].value[1, :2]).all()
    assert np.nanmax(found["walk"].value[:, :2]) < 1e-6
    assert found["jog"].value.max() < 1e-6
    assert found["jog"].value.shape == (4, 3)


def test_a_shift_of_all_frames_is_measured_but_a_common_one_is_the_surface(world):
    truth, bones = world
    moved = {k: aligned(t.vertices, t.faces) for k, t in truth.items()}
    shifted = moved["jog"].mesh.vertices + np.float32([0.03, 0, 0.04])
    moved["jog"] = aligned(shifted, truth["jog"].faces)
    found = correspondence(moved, truth, bones)
    assert found["jog"].value[:, 0] == pytest.approx(0.05, abs=1e-5)
    assert np.nanmax(found["walk"].value[:, 0]) < 1e-6


def test_sliding_along_the_surface_counts_though_the_surface_is_met(world):
    truth, bones = world
    slid = {k: aligned(t.vertices, t.faces) for k, t in truth.items()}
    # a ring of vertices further on: every vertex lies on the true surface, at another point of it
    order = np.roll(np.arange(truth["jog"].vertices.shape[1]), 7)
    slid["jog"] = aligned(truth["jog"].vertices[:, order], truth["jog"].faces)
    expected = np.linalg.norm(truth["jog"].vertices[:, order] - truth["jog"].vertices, axis=2)
    found = correspondence(slid, truth, bones)["jog"].value
    assert found[:, 0] == pytest.approx(expected.mean(axis=1), rel=1e-4)
    assert found[:, 1] == pytest.approx(np.percentile(expected, 99, axis=1), rel=1e-4)


def test_swapped_legs_are_counted_frame_by_frame(world):
    truth, bones = world
    vertices = truth["jog"].vertices.copy()
    half = vertices.shape[1] // 2
    vertices[2] = np.roll(vertices[2], half, axis=0)
    both = {
        "walk": aligned(truth["walk"].vertices, truth["walk"].faces),
        "jog": aligned(vertices, truth["jog"].faces),
    }
    found = correspondence(both, truth, bones)
    assert found["jog"].value[:, 2].tolist() == [0, 0, 1, 0]
    assert found["walk"].value[:, 2].sum() == 0
    assert found["jog"].value[2, 0] > 0.2


def test_what_does_not_belong_together_is_refused(world):
    truth, bones = world
    good = {k: aligned(t.vertices, t.faces) for k, t in truth.items()}
    with pytest.raises(ValueError, match="no truth for take 'jog'"):
        correspondence(good, {"walk": truth["walk"]}, bones)
    short = good | {"jog": aligned(truth["jog"].vertices[:2], truth["jog"].faces)}
    with pytest.raises(ValueError, match="take 'jog' must have the frames of its truth, 4, got 2"):
        correspondence(short, truth, bones)
    other = good | {"jog": aligned(truth["jog"].vertices, truth["jog"].faces[::-1].copy())}
    with pytest.raises(ValueError, match="take 'jog' differs"):
        correspondence(other, truth, bones)
    nameless = {k: b._replace(names=np.array(["a", "b", "c", "d", "e"])) for k, b in bones.items()}
    with pytest.raises(ValueError, match="left_X and right_X, got a, b"):
        correspondence(good, truth, nameless)
