import numpy as np
import pytest

from reperform.nodes.evaluate.warped_transitions import warped_transitions
from reperform.nodes.motion_graph.essential import essential
from reperform.nodes.motion_graph.pose_transitions import pose_transitions
from reperform.nodes.similarity.vertex_velocity import vertex_velocity
from reperform.nodes.studio.perform import perform


@pytest.fixture(scope="module")
def marks():
    motions = {"walk": "walk", "jog": "walk_to_jog"}
    meshes = {
        take: perform(motion=motion, costume="jacket", seconds=1.4).mesh for take, motion in motions.items()
    }
    likeness = {(a, b): vertex_velocity((meshes[a], meshes[b])) for a in meshes for b in meshes}
    pairs = {(a, b): pose_transitions(likeness[a, b], (meshes[a], meshes[b])) for a in meshes for b in meshes}
    out = warped_transitions(essential(pairs), likeness, meshes, count=5)
    return dict(zip(out.name.tolist(), out.value.T, strict=True))


def test_held_feet_stand_and_others_slide(marks):
    assert np.nanmax(marks["warped skate"]) < 0.02
    assert np.nanmean(marks["unheld skate"]) > np.nanmean(marks["warped skate"])
    assert np.nanmean(marks["fixed skate"]) > 0.02


def test_every_mark_is_measured_once_per_transition(marks):
    assert all(len(column) == 5 for column in marks.values())
    assert (marks["warped volume"] >= 0).all()
    # what holding feet does to the volume is made good
    assert marks["warped volume"].max() < 1e-4 < marks["unheld volume"].max() < marks["fixed volume"].max()
    assert (marks["fixed junction"] > 0).all()
