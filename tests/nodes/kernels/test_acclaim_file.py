import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from reperform.nodes.kernels.acclaim_file import parse_amc, parse_asf
from reperform.nodes.kernels.articulation import joint_positions

ASF = """# made by hand
:version 1.10
:units
  mass 1.0
  length 0.45
  angle deg
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name thigh
    direction 0 -1 0
    length 4
    axis 10 20 30 XYZ
    dof rx rz
    limits (-160.0 20.0)
           (-60.0 70.0)
  end
  begin
    id 2
    name shin
    direction 0 -2 0
    length 3
    axis 0 0 20 XYZ
    dof ry
  end
:hierarchy
  begin
    root thigh
    thigh shin
  end
"""
AMC = """#!OML:ASF
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 10 20 30
thigh 40 50
shin 60
2
root 1 2 4 0 0 0
thigh 0 0
shin 0
"""
METRES = 0.0254 / 0.45


def turned(x: float, y: float, z: float) -> np.ndarray:
    return np.asarray(Rotation.from_euler("xyz", [x, y, z], degrees=True).as_matrix())


def test_bones_turn_about_their_own_axes() -> None:
    motion = parse_amc(AMC.replace("\n", "\r\n"), parse_asf(ASF.replace("\n", "\r\n")))
    assert motion.names == ["root", "thigh", "shin", "shin_end"]
    joints = joint_positions(motion.parents, motion.offset, motion.root, motion.turn) / METRES
    c, d = turned(10, 20, 30), turned(0, 0, 20)
    thigh = turned(10, 20, 30) @ c @ turned(40, 0, 50) @ c.T
    shin = thigh @ d @ turned(0, 60, 0) @ d.T
    knee = np.array([1, 2, 3]) + thigh @ [0, -4, 0]
    np.testing.assert_allclose(joints[0], [[1, 2, 3], [1, 2, 3], knee, knee + shin @ [0, -3, 0]], atol=1e-12)
    np.testing.assert_allclose(joints[1], [[1, 2, 4], [1, 2, 4], [1, -2, 4], [1, -5, 4]], atol=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (AMC.replace("shin 60", "shin 60 1"), "line 7: 'shin' must be a bone with 1 values, got 2"),
        (AMC.replace("shin 60", "toe 60"), "is this the skeleton"),
        (AMC.replace("shin 0\n", ""), "cut short"),
    ],
)
def test_motion_of_another_skeleton_is_refused(text: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        parse_amc(text, parse_asf(ASF))


def test_a_skeleton_must_hold_together() -> None:
    with pytest.raises(ValueError, match=":hierarchy"):
        parse_asf(ASF.split(":hierarchy", maxsplit=1)[0])
    with pytest.raises(ValueError, match="'shin' must hang on root"):
        parse_asf(ASF.replace("    thigh shin\n", ""))
