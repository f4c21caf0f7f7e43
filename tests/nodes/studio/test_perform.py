import typing

import numpy as np
import pytest

from reperform.nodes.kernels.mesh_geometry import volume
from reperform.nodes.studio.motions import Motion
from reperform.nodes.studio.perform import perform

MOTIONS = typing.get_args(Motion)
SECONDS = {"jump_high": 1.7, "jump_long": 1.7, "dance": 2.4}


@pytest.fixture(scope="module")
def takes():
    return {motion: perform(motion=motion, seconds=SECONDS.get(motion, 1.4)) for motion in MOTIONS}


@pytest.mark.parametrize("motion", MOTIONS)
def test_planted_feet_stay_and_nothing_sinks(takes, motion):
    take = takes[motion]
    toes = [list(take.skeleton.names).index(f"{side}_toe") for side in ("left", "right")]
    places = take.skeleton.joints[:, toes].astype(float)
    planted = take.contacts.planted
    both = planted[1:] & planted[:-1]
    speed = np.linalg.norm(np.diff(places, axis=0), axis=-1) * 25
    assert both.any()
    assert speed[both].max() < 0.005
    # the ball of the foot is 22 mm over the sole
    np.testing.assert_allclose(places[..., 1][planted], 0.022, atol=1e-3)
    assert take.mesh.vertices[..., 1].min() > -0.03


@pytest.mark.parametrize("motion", MOTIONS)
def test_bones_keep_their_lengths_and_the_body_its_volume(takes, motion):
    take = takes[motion]
    joints, parents = take.skeleton.joints, take.skeleton.parents
    lengths = np.linalg.norm(joints[:, 1:] - joints[:, parents[1:]], axis=-1)
    np.testing.assert_allclose(lengths, lengths[:1].repeat(len(lengths), axis=0), atol=1e-5)
    sizes = volume(take.mesh.vertices, take.mesh.faces)
    assert sizes.min() > 0.07
    assert sizes.max() / sizes.min() < 1.35


@pytest.mark.parametrize("motion", MOTIONS)
def test_motion_is_smooth(takes, motion):
    joints = takes[motion].skeleton.joints.astype(float)
    acceleration = np.linalg.norm(np.diff(joints, 2, axis=0), axis=-1) * 25**2
    assert acceleration.max() < 220
    assert np.isfinite(takes[motion].mesh.vertices).all()


def test_one_topology_and_texture_for_all_motions(takes):
    for take in takes.values():
        assert np.array_equal(take.mesh.faces, takes["walk"].mesh.faces)
        assert np.array_equal(take.texture.image, takes["walk"].texture.image)
        assert np.array_equal(take.texture.faces_uv, takes["walk"].texture.faces_uv)


def test_speed_is_as_asked_and_transitions_begin_and_end_like_their_neighbours(takes):
    def ground_speed(motion: str) -> np.ndarray:
        return (
            np.linalg.norm(np.diff(takes[motion].skeleton.joints[:, 0, [0, 2]].astype(float), axis=0), axis=1)
            * 25
        )

    assert ground_speed("walk").mean() == pytest.approx(1.3, rel=0.05)
    assert ground_speed("jog").mean() == pytest.approx(2.4, rel=0.05)
    assert ground_speed("stand").max() < 0.02
    assert ground_speed("stand_to_walk")[0] < 0.05
    assert ground_speed("stand_to_walk")[-3:].mean() == pytest.approx(1.3, rel=0.1)
    assert ground_speed("walk_to_jog")[-3:].mean() == pytest.approx(2.4, rel=0.1)

    def shape(motion: str, frame: int) -> np.ndarray:
        joints = takes[motion].skeleton.joints[frame].astype(float)
        return joints - joints[0] * (1, 0, 1)

    assert np.abs(shape("stand_to_walk", 0) - shape("stand", 0)).max() < 0.02
    assert np.abs(shape("walk_to_stand", -1) - shape("stand", 0)).max() < 0.02
    nearest = min(np.abs(shape("stand_to_walk", -1) - shape("walk", k)).max() for k in range(30))
    assert nearest < 0.08


def test_a_gait_leaves_the_ground_only_when_jogging(takes):
    assert takes["walk"].contacts.planted.any(axis=1).mean() > 0.7
    low = takes["jog"].skeleton.joints[:, :, 1].min(axis=1)
    assert (low > 0.024).any()


def test_turns_turn_by_the_rate_and_mirror_each_other():
    def yaw(motion: str) -> float:
        take = perform(motion=motion, seconds=1.0, turn=0.8)
        names = list(take.skeleton.names)
        across = (
            take.skeleton.joints[:, names.index("left_thigh")]
            - take.skeleton.joints[:, names.index("right_thigh")]
        )
        angle = np.unwrap(np.arctan2(-across[:, 2], across[:, 0]).astype(float))
        # a whole gait cycle, so that the hips' own swing cancels
        return float(angle[-1] - angle[0])

    assert yaw("turn_left") == pytest.approx(0.77, abs=0.25)
    assert yaw("turn_right") == pytest.approx(-0.77, abs=0.25)


@pytest.mark.parametrize("height", [0.2, 0.45])
def test_a_jump_rises_by_its_height(height):
    take = perform(motion="jump_high", seconds=1.8, height=height)
    hips = take.skeleton.joints[:, 0, 1]
    assert hips.max() - hips[0] == pytest.approx(height, abs=0.03)
    assert not take.contacts.planted[hips.argmax()].any()


def test_a_long_jump_lands_where_asked():
    take = perform(motion="jump_long", seconds=1.8, length=0.9)
    toe = take.skeleton.joints[:, list(take.skeleton.names).index("left_toe")]
    assert toe[-1, 2] - toe[0, 2] == pytest.approx(0.9, abs=1e-3)


@pytest.mark.parametrize(
    ("motion", "bone", "height"), [("reach_high", "right_hand", 1.6), ("duck", "head", 1.2)]
)
def test_height_is_reached(motion, bone, height):
    take = perform(motion=motion, seconds=1.6, height=height)
    level = take.skeleton.joints[:, list(take.skeleton.names).index(bone), 1]
    assert (level.max() if motion == "reach_high" else level.min()) == pytest.approx(height, abs=0.015)


@pytest.mark.parametrize("width", [0.35, 0.8])
def test_hands_are_as_far_apart_as_the_box_is_wide(width):
    take = perform(motion="grab", seconds=1.6, width=width)
    names = list(take.skeleton.names)
    left, right = (take.skeleton.joints[:, names.index(f"{side}_hand")] for side in ("left", "right"))
    held = round(0.49 * 1.6 * 25)
    assert np.linalg.norm(left - right, axis=1)[held] == pytest.approx(width, abs=0.01)
    # in front of the chest, at one height
    assert left[held, 2] - take.skeleton.joints[held, 0, 2] > 0.3
    assert left[held, 1] == pytest.approx(right[held, 1], abs=0.02)


def test_what_cannot_be_done_is_refused():
    with pytest.raises(ValueError, match=r"width must be .* got 1\.90 m"):
        perform(motion="grab", width=1.9)
    with pytest.raises(ValueError, match=r"needs at least .* s, got 0\.50 s: raise seconds"):
        perform(motion="jump_high", seconds=0.5)
    with pytest.raises(ValueError, match=r"height must be .* got 2\.39 m"):
        perform(motion="reach_high", height=2.39)


def test_stature_scales_and_heading_turns():
    plain, big = perform(seconds=0.4, motion="stand"), perform(seconds=0.4, motion="stand", stature=1.892)
    np.testing.assert_allclose(big.mesh.vertices, plain.mesh.vertices * 1.1, atol=2e-5)
    turned = perform(seconds=0.4, motion="stand", heading=np.pi / 2)
    x, y, z = np.moveaxis(plain.mesh.vertices, -1, 0)
    np.testing.assert_allclose(turned.mesh.vertices, np.stack([z, y, -x], axis=-1), atol=2e-4)


def test_the_skirt_moves_after_the_body():
    take, still = perform(motion="stand_to_walk"), perform(motion="stand")
    faces = take.mesh.faces
    hem = np.flatnonzero((still.mesh.vertices[0, :, 1] > 0.52) & (still.mesh.vertices[0, :, 1] < 0.60))
    out = np.linalg.norm(still.mesh.vertices[0, hem][:, [0, 2]] - still.skeleton.joints[0, 0, [0, 2]], axis=1)
    hem = hem[out > 0.2]
    relative = take.mesh.vertices[:, hem] - take.skeleton.joints[:, :1]
    assert len(hem) > 40 and len(faces) > 5000
    assert np.linalg.norm(relative - relative[0], axis=-1).max() > 0.05


def test_the_same_twice(takes):
    again = perform(motion="jog", seconds=1.4)
    assert np.array_equal(again.mesh.vertices, takes["jog"].mesh.vertices)


def test_bones_turn_with_the_joints_they_hang_on():
    take = perform(motion="dance", costume="jacket", seconds=0.8)
    joints, rotation, parents = take.skeleton.joints, take.bones.rotation, take.bones.parents
    child = np.flatnonzero(parents >= 0)
    way = joints[:, child] - joints[:, parents[child]]
    at_rest = np.einsum("tkji,tkj->tki", rotation[:, parents[child]], way)
    np.testing.assert_allclose(at_rest, np.broadcast_to(at_rest[:1], at_rest.shape), atol=1e-4)
