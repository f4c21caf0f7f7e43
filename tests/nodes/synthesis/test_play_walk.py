import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.synthesis.play_walk import play_walk
from reperform.nodes.synthesis.pose_to_pose import pose_to_pose


@pytest.fixture(scope="module")
def walk(pose_graph, likeness, strides):
    return pose_to_pose(pose_graph, likeness, strides, start="ahead:3", via=("left:12",), end="right:20")


@pytest.mark.parametrize("blend", ["nonlinear", "linear"])
def test_frames_of_one_source_are_the_captured_ones_moved_as_a_whole(walk, strides, blend):
    animation = play_walk(walk, strides, blend=blend)
    names = list(strides)
    for f in np.flatnonzero(walk.weight.max(axis=1) == 1.0):
        side = int(walk.weight[f].argmax())
        captured = strides[names[walk.take[f, side]]].vertices[int(walk.time[f, side])]
        placed = apply(captured, Placement(walk.yaw[f, side], walk.offset[f, side]))
        np.testing.assert_allclose(animation.mesh.vertices[f], placed, atol=1e-6)


def test_motion_goes_on_smoothly_over_junctions(walk, strides):
    vertices = play_walk(walk, strides).mesh.vertices.astype(np.float64)
    own = max(
        np.linalg.norm(np.diff(t.vertices.astype(float), 2, axis=0), axis=-1).max() for t in strides.values()
    )
    played = np.linalg.norm(np.diff(vertices, 2, axis=0), axis=-1).max()
    assert played < 2.0 * own
    middle = vertices.mean(axis=1)
    np.testing.assert_allclose(middle, walk.middle, atol=0.03)


def test_provenance_names_captured_frames(walk, strides):
    origin = play_walk(walk, strides).provenance
    np.testing.assert_allclose(origin.source_frame, walk.time, atol=0.5)
    np.testing.assert_allclose(origin.weight.sum(axis=1), 1.0, atol=1e-6)


def test_a_missing_take_is_named(walk, strides):
    with pytest.raises(ValueError, match="plays 'left'; the meshes have ahead, right"):
        play_walk(walk, {take: strides[take] for take in ("ahead", "right")})
