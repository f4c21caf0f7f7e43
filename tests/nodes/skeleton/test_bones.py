import numpy as np

from reperform.nodes.products.performance import SkeletonSequence
from reperform.nodes.skeleton.bones import bones


def test_every_bone_is_a_face_from_parent_to_joint() -> None:
    joints = np.random.default_rng(0).normal(size=(3, 4, 3)).astype(np.float32)
    parents = np.array([-1, 0, 1, 0], np.int32)
    made = bones(SkeletonSequence(joints, parents, np.array(list("abcd")), np.float32(30)))
    np.testing.assert_array_equal(made.vertices, joints)
    assert made.faces.tolist() == [[0, 1, 1], [1, 2, 2], [0, 3, 3]]
    assert float(made.fps) == 30
