import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from reperform.nodes.kernels.articulation import (
    Articulation,
    euler,
    joint_positions,
    local_turns,
    resampled,
    world_turns,
)

PARENTS = np.array([-1, 0, 1, 0])
OFFSET = np.array([[0, 0, 0], [0.1, 0.5, 0], [0, 0.3, -0.2], [-0.2, 0.1, 0.4]])


def motion(frames: int = 7) -> Articulation:
    """A skeleton that turns by up to half a radian per frame."""
    random = np.random.default_rng(2)
    turn = np.tile(Rotation.random(4, random_state=3).as_matrix(), (frames, 1, 1, 1))
    for f in range(1, frames):
        turn[f] = turn[f - 1] @ Rotation.from_rotvec(random.normal(0, 0.3, (4, 3))).as_matrix()
    return Articulation(list("abcd"), PARENTS, OFFSET, random.normal(size=(frames, 3)), turn)


def test_euler_angles_multiply_as_listed() -> None:
    angles = np.random.default_rng(1).uniform(-3, 3, (6, 3))
    expected = Rotation.from_euler("ZXY", angles).as_matrix()
    np.testing.assert_allclose(euler(angles, "ZXY"), expected, atol=1e-12)


def test_turns_against_the_parent_and_back() -> None:
    made = motion()
    np.testing.assert_allclose(world_turns(PARENTS, local_turns(PARENTS, made.turn)), made.turn, atol=1e-12)


def test_joints_hang_on_their_parents_by_turned_offsets() -> None:
    made = motion()
    joints = joint_positions(PARENTS, OFFSET, made.root, made.turn)
    np.testing.assert_allclose(joints[4, 2], joints[4, 1] + made.turn[4, 1] @ OFFSET[2])
    np.testing.assert_allclose(joints[:, 0], made.root)


def test_resampling_goes_the_shortest_way_and_keeps_frames_it_meets() -> None:
    made = motion(7)
    out = resampled(made, 120.0, 160.0)
    assert len(out.root) == 9
    np.testing.assert_allclose(out.turn[::4], made.turn[::3], atol=1e-9)
    local = local_turns(PARENTS, made.turn)
    slerp = Slerp([0, 1], Rotation.from_matrix(local[3:5, 2]))
    np.testing.assert_allclose(local_turns(PARENTS, out.turn)[5, 2], slerp(0.75).as_matrix(), atol=1e-9)
    np.testing.assert_allclose(out.root[5], 0.25 * made.root[3] + 0.75 * made.root[4])
