import numpy as np

from reperform.nodes.kernels.gradual_placement import gradual_placement
from reperform.nodes.kernels.ground_plane import Placement, align, apply
from reperform.nodes.kernels.path_frames import ease

RANDOM = np.random.default_rng(3)
COUNT = 13
WEIGHT = ease((COUNT - 1) // 2)


def walk(start, heading, speed, turn, pose):
    """A rigid cloud that walks: (K, P, 3)."""
    frames, place = [], np.array(start, float)
    for _ in range(COUNT):
        frames.append(apply(pose, Placement(heading, place.copy())))
        place += speed * np.array([np.sin(heading), np.cos(heading)])
        heading += turn
    return np.stack(frames)


POSE = RANDOM.normal(size=(30, 3)) * (0.2, 0.5, 0.3)


def test_the_source_starts_where_it_was_captured_and_the_target_lies_on_it_in_every_frame():
    source = walk((1, 2), 0.3, 0.05, 0.02, POSE)
    target = walk((-4, 0.5), -2.0, 0.09, -0.01, POSE + 0.02 * RANDOM.normal(size=POSE.shape))
    yaw, offset = gradual_placement(source, target, WEIGHT)
    assert yaw[0, 0] == 0.0
    assert (offset[0, 0] == 0.0).all()
    for k in range(COUNT):
        placed = apply(source[k], Placement(yaw[k, 0], offset[k, 0]))
        best, _ = align(placed, target[k])
        assert abs(np.sin(best.yaw - yaw[k, 1])) < 1e-9
        np.testing.assert_allclose(best.offset, offset[k, 1], atol=1e-9)


def test_speed_and_turn_go_from_those_of_the_source_to_those_of_the_target():
    source = walk((1, 2), 0.3, 0.05, 0.03, POSE)
    target = walk((-4, 0.5), -2.0, 0.09, -0.01, POSE)
    yaw, offset = gradual_placement(source, target, WEIGHT)
    middle = np.array(
        [
            apply(s, Placement(y, o)).mean(axis=0)[[0, 2]]
            for s, y, o in zip(source, yaw[:, 0], offset[:, 0], strict=True)
        ]
    )
    speed = np.linalg.norm(np.diff(middle, axis=0), axis=1)
    mean = 0.5 * (WEIGHT[1:] + WEIGHT[:-1])
    # the pose's mean is off the axis it turns about, so turns add a little
    np.testing.assert_allclose(speed, 0.05 + mean * 0.04, atol=6e-3)
    heading = 0.3 + 0.03 * np.arange(COUNT) + yaw[:, 0]
    np.testing.assert_allclose(np.diff(heading), 0.03 - 0.04 * mean, atol=1e-9)


def test_where_the_capture_stands_does_not_matter():
    source = walk((1, 2), 0.3, 0.05, 0.03, POSE)
    target = walk((-4, 0.5), -2.0, 0.09, -0.01, POSE)
    yaw, offset = gradual_placement(source, target, WEIGHT)
    elsewhere = Placement(1.1, np.array([3.0, -2.0]))
    other_yaw, other_offset = gradual_placement(source, apply(target, elsewhere), WEIGHT)
    np.testing.assert_allclose(other_yaw[:, 0], yaw[:, 0], atol=1e-9)
    np.testing.assert_allclose(other_offset[:, 0], offset[:, 0], atol=1e-9)
