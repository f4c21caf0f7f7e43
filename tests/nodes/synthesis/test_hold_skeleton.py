from collections.abc import Mapping

import numpy as np
import pytest

from reperform.nodes.kernels.bone_mesh import bone_faces
from reperform.nodes.kernels.foot_contacts import foot_contacts
from reperform.nodes.kernels.path_contacts import path_contacts
from reperform.nodes.motion_graph.skeletal import skeletal
from reperform.nodes.products.mocap import Mocap, SkeletalAnimation
from reperform.nodes.similarity.vertex_velocity import vertex_velocity
from reperform.nodes.skeleton.bones import bones
from reperform.nodes.synthesis.animate_skeleton import animate_skeleton
from reperform.nodes.synthesis.endless import endless
from reperform.nodes.synthesis.hold_skeleton import hold_skeleton


@pytest.fixture(scope="module")
def played(striders: Mapping[str, Mocap]) -> SkeletalAnimation:
    points = {name: bones(take.skeleton) for name, take in striders.items()}
    similarity = {(a, b): vertex_velocity((points[a], points[b])) for a in points for b in points}
    graph = skeletal(similarity, {name: take.skeleton for name, take in striders.items()})
    return animate_skeleton(endless(graph, points, seconds=8.0, seed=1), striders)


def test_resting_feet_stand_still_and_bones_keep_their_lengths(
    striders: Mapping[str, Mocap], played: SkeletalAnimation
) -> None:
    held = hold_skeleton(played, striders, height=0.03, speed=0.4)
    takes = [take.skeleton.joints for take in striders.values()]
    found = foot_contacts(takes, bone_faces(played.mocap.skeleton.parents), 25.0, 0.03, 0.4)
    source = played.provenance
    order = np.array([list(striders).index(str(take)) for take in source.takes])
    planted = path_contacts(order[source.take], source.source_frame, source.weight, found.planted)
    assert found.foot.tolist() == [-1, -1, -1, -1, 0, -1, -1, -1, 1, -1, -1]
    for animation, most in ((played, np.inf), (held, 1e-3)):
        joints = animation.mocap.skeleton.joints.astype(float)
        speeds = [
            np.linalg.norm(np.diff(joints[:, ball], axis=0), axis=1)[planted[1:, k] & planted[:-1, k]] * 25
            for k, ball in enumerate((4, 8))
        ]
        fastest = np.concatenate(speeds).max()
        assert fastest < most
        assert animation is held or fastest > 0.1
    parents = played.mocap.skeleton.parents
    bone = np.linalg.norm(
        held.mocap.skeleton.joints[:, 1:] - held.mocap.skeleton.joints[:, parents[1:]], axis=2
    )
    np.testing.assert_allclose(bone, np.tile(bone[:1], (len(bone), 1)), atol=1e-5)
    gap = held.mocap.skeleton.joints - played.mocap.skeleton.joints
    assert np.linalg.norm(gap, axis=2).max() < 0.25


def test_what_hardly_rests_hardly_changes(striders: Mapping[str, Mocap], played: SkeletalAnimation) -> None:
    held = hold_skeleton(played, striders, height=0.001, speed=0.01)
    np.testing.assert_allclose(held.mocap.skeleton.joints, played.mocap.skeleton.joints, atol=1e-3)


def test_a_missing_take_is_refused(striders: Mapping[str, Mocap], played: SkeletalAnimation) -> None:
    name = str(played.provenance.takes[played.provenance.take[0, 0]])
    with pytest.raises(ValueError, match=f"the motion plays '{name}'"):
        hold_skeleton(played, {k: v for k, v in striders.items() if k != name})
