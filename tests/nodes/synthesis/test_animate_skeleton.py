from collections.abc import Mapping

import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.motion_graph.skeletal import skeletal
from reperform.nodes.products.mocap import Mocap
from reperform.nodes.products.motion import MotionPath
from reperform.nodes.similarity.vertex_velocity import vertex_velocity
from reperform.nodes.skeleton.bones import bones
from reperform.nodes.synthesis.animate_skeleton import animate_skeleton
from reperform.nodes.synthesis.endless import endless


@pytest.fixture(scope="module")
def path(striders: Mapping[str, Mocap]) -> MotionPath:
    points = {name: bones(take.skeleton) for name, take in striders.items()}
    similarity = {(a, b): vertex_velocity((points[a], points[b])) for a in points for b in points}
    graph = skeletal(similarity, {name: take.skeleton for name, take in striders.items()})
    return endless(graph, points, seconds=10.0, seed=4)


def test_captured_frames_are_played_as_captured_and_bones_keep_their_lengths(
    striders: Mapping[str, Mocap], path: MotionPath
) -> None:
    played = animate_skeleton(path, striders)
    source, joints = played.provenance, played.mocap.skeleton.joints
    alone = np.flatnonzero(source.weight[:, 0] == 1.0)
    assert 0 < len(alone) < len(joints)
    for f in alone:
        captured = striders[source.takes[source.take[f, 0]]].skeleton.joints[source.source_frame[f, 0]]
        placed = apply(captured, Placement(source.yaw[f, 0], source.offset[f, 0]))
        np.testing.assert_allclose(joints[f], placed, atol=2e-5)
    parents = played.mocap.skeleton.parents
    bone = np.linalg.norm(joints[:, 1:] - joints[:, parents[1:]], axis=2)
    np.testing.assert_allclose(
        bone, np.tile(np.linalg.norm(played.mocap.offset[1:], axis=1), (len(bone), 1)), atol=1e-5
    )


def test_blends_lie_between_their_sources_and_nothing_jumps(
    striders: Mapping[str, Mocap], path: MotionPath
) -> None:
    joints = animate_skeleton(path, striders).mocap.skeleton.joints
    own = max(np.linalg.norm(np.diff(t.skeleton.joints, axis=0), axis=2).max() for t in striders.values())
    assert np.linalg.norm(np.diff(joints, axis=0), axis=2).max() < 1.3 * own


def test_a_missing_take_and_another_skeleton_are_refused(
    striders: Mapping[str, Mocap], path: MotionPath
) -> None:
    name = str(path.provenance.takes[path.provenance.take[0, 0]])
    with pytest.raises(ValueError, match=f"the path plays '{name}'"):
        animate_skeleton(path, {k: v for k, v in striders.items() if k != name})
    longer = striders[name]._replace(offset=striders[name].offset * np.float32(1.1))
    with pytest.raises(ValueError, match="must be of one skeleton"):
        animate_skeleton(path, {**striders, name: longer})
