import numpy as np
import pytest

from reperform.nodes.synthesis.pose_to_pose import pose_to_pose


@pytest.mark.parametrize(
    ("start", "end"), [("ahead:3", "left:20"), ("right:22", "right:5"), ("left:-1", "ahead:0")]
)
def test_the_way_costs_what_the_graph_says_and_shows_both_poses_as_captured(
    pose_graph, likeness, strides, start, end
):
    walk = pose_to_pose(pose_graph, likeness, strides, start=start, end=end)
    names, frames = list(strides), [len(take.vertices) for take in strides.values()]
    poses = []
    for text in (start, end):
        take, frame = text.split(":")
        poses.append(sum(frames[: names.index(take)]) + int(frame) % frames[names.index(take)])
    np.testing.assert_allclose(walk.cost, pose_graph.distance[poses[0], poses[1]])
    for shown, text in zip(walk.shown, (start, end), strict=True):
        take, frame = text.split(":")
        side = int(walk.weight[shown].argmax())
        assert walk.weight[shown, side] == 1.0
        assert names[walk.take[shown, side]] == take
        assert walk.time[shown, side] == int(frame) % frames[names.index(take)]


def test_poses_in_between_are_passed_in_order(pose_graph, likeness, strides):
    walk = pose_to_pose(
        pose_graph, likeness, strides, start="ahead:2", via=("left:9", "ahead:11"), end="right:6"
    )
    assert (np.diff(walk.shown) > 0).all()
    assert walk.pose[0] == 2
    assert 26 + 9 in walk.pose
    assert walk.shown[-1] == len(walk.time) - 1


def test_one_take_and_the_same_pose_twice_are_refused(pose_graph, likeness, strides):
    with pytest.raises(ValueError, match="start and end are one pose"):
        pose_to_pose(pose_graph, likeness, strides, start="left:4", end="left:4")
    with pytest.raises(ValueError, match=r"'back:4' must read TAKE:FRAME with a take of ahead, left, right"):
        pose_to_pose(pose_graph, likeness, strides, start="back:4", end="left:4")
    with pytest.raises(ValueError, match=r"take left has frames 0 \.\. 27"):
        pose_to_pose(pose_graph, likeness, strides, start="left:28", end="left:4")


def test_meshes_of_another_graph_are_refused(pose_graph, likeness, strides):
    other = {**strides, "left": strides["right"]}
    with pytest.raises(ValueError, match="take 'left' has 28 frames in the graph and 24 in the meshes"):
        pose_to_pose(pose_graph, likeness, other, start="left:3", end="left:4")
