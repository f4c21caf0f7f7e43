import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from reperform.nodes.kernels.articulation import joint_positions
from reperform.nodes.kernels.bvh_file import parse_bvh

SMALL = """HIERARCHY
ROOT Hips
{
  OFFSET 1 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
  JOINT Left Leg
  {
    OFFSET 0 -2 0.5
    CHANNELS 3 Yrotation Xrotation Zrotation
    End Site
    {
      OFFSET 0 -1 0
    }
  }
  JOINT Stump
  {
    OFFSET 0 1 0
    CHANNELS 3 Zrotation Yrotation Xrotation
    End Site
    {
      OFFSET 0 0 0
    }
  }
}
MOTION
Frames: 2
Frame Time: .0083333
0 5 0 10 20 30 -40 15 25 1 2 3
1 5 2 40 0 -30 60 -5 5 4 5 6
"""


def test_channels_multiply_in_their_own_order_and_ends_become_joints() -> None:
    motion, rate = parse_bvh(SMALL.replace("\n", "\r\n"))
    assert motion.names == ["Hips", "Left_Leg", "Left_Leg_end", "Stump"]
    assert rate == pytest.approx(120, rel=1e-4)
    joints = joint_positions(motion.parents, motion.offset, motion.root, motion.turn)
    hips = Rotation.from_euler("ZYX", [40, 0, -30], degrees=True)
    leg = hips * Rotation.from_euler("YXZ", [60, -5, 5], degrees=True)
    knee = np.array([2, 5, 2]) + hips.apply([0, -2, 0.5])
    np.testing.assert_allclose(
        joints[1], [[2, 5, 2], knee, knee + leg.apply([0, -1, 0]), [2, 5, 2] + hips.apply([0, 1, 0])]
    )


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("1 5 2 40 0 -30 60 -5 5 4 5 6\n", "1 5 2\n", "2 frames of 12 channels"),
        ("MOTION\n", "", "not understood|must follow"),
        ("Frame Time: .0083333\n", "", "Frame Time"),
        ("JOINT Left Leg", "ROOT Left Leg", "line 6: one ROOT"),
    ],
)  # fmt: skip
def test_what_is_not_whole_is_refused(old: str, new: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        parse_bvh(SMALL.replace(old, new))
