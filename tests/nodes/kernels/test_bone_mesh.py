import numpy as np

from reperform.nodes.kernels.bone_mesh import bone_faces


def test_every_joint_with_a_parent_makes_a_face() -> None:
    assert bone_faces(np.array([-1, 0, 0, 2])).tolist() == [[0, 1, 1], [0, 2, 2], [2, 3, 3]]
