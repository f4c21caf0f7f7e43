import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.chart_atlas import texel_hits
from reperform.nodes.studio.actor import build_actor
from reperform.nodes.studio.actor_skeleton import BONE


@pytest.fixture(scope="module", params=["skirt", "jacket", "dress"])
def actor(request):
    return build_actor(request.param)


def test_the_surface_is_one_closed_ball(actor):
    mesh = trimesh.Trimesh(actor.vertices, actor.faces, process=False)
    assert mesh.is_watertight and mesh.is_winding_consistent
    assert mesh.euler_number == 2
    assert mesh.volume > 0.07
    assert 3000 <= len(actor.vertices) <= 6000
    assert 1.70 < actor.vertices[:, 1].max() < 1.75
    assert -1e-3 < actor.vertices[:, 1].min() < 1e-3


def test_weights_are_a_partition_and_follow_the_nearest_bone(actor):
    np.testing.assert_allclose(actor.weights.sum(axis=1), 1, atol=1e-5)
    assert actor.weights.min() >= 0
    top = actor.vertices[:, 1] > 1.6
    assert actor.weights[top, BONE["head"]].min() > 0.9
    left_hand = actor.vertices[:, 0] > 0.56
    assert left_hand.any() and actor.weights[left_hand, BONE["left_hand"]].min() > 0.9
    right = [index for name, index in BONE.items() if name.startswith("right_")]
    assert actor.weights[actor.vertices[:, 0] > 0.3][:, right].max() < 1e-3


def test_the_atlas_shows_every_face_once_in_many_colours(actor):
    assert actor.uv.min() >= 0 and actor.uv.max() <= 1
    height, width = actor.image.shape[:2]
    ids, _ = texel_hits(actor.uv, actor.faces_uv, height, width)
    shown = np.bincount(ids[ids >= 0], minlength=len(actor.faces))
    assert (shown > 0).mean() > 0.97
    # something to hold on to: fine detail nearly everywhere, and no backdrop blue
    painted = (ids[:, 1:] >= 0) & (ids[:, :-1] >= 0)
    detail = np.abs(np.diff(actor.image.astype(int), axis=1)).sum(-1)
    assert np.median(detail[painted]) >= 5
    assert (ids >= 0).mean() > 0.40
    r, g, b = (actor.image[..., k].astype(int) for k in range(3))
    assert ((b > r + 40) & (b > g + 25)).mean() < 1e-3


def test_the_garment_is_found_by_angle_and_height(actor):
    on = ~np.isnan(actor.garment[:, 0])
    assert 300 < on.sum() < len(actor.vertices) - 1000
    assert (actor.garment[on] >= 0).all() and (actor.garment[on] <= 1).all()
    front = on & (np.abs(actor.vertices[:, 0]) < 0.02) & (actor.vertices[:, 2] > 0.1)
    back = on & (np.abs(actor.vertices[:, 0]) < 0.02) & (actor.vertices[:, 2] < -0.1)
    turns = actor.garment[:, 1]
    apart = np.abs(np.angle(np.exp(2j * np.pi * (turns[front].mean() - turns[back]))))
    assert np.abs(apart - np.pi).max() < 0.5
