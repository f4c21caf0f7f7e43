from collections.abc import Mapping

import numpy as np

from reperform.nodes.evaluate.bone_change import bone_change
from reperform.nodes.products.mocap import Mocap, SkeletalAnimation
from reperform.nodes.products.motion import Provenance


def test_a_stretched_shin_shows(striders: Mapping[str, Mocap]) -> None:
    take, empty = striders["slow"], np.zeros((0, 2))
    joints = take.skeleton.joints.copy()
    joints[7, 3:5] += 0.1 * (joints[7, 3] - joints[7, 2])
    stretched = take._replace(skeleton=take.skeleton._replace(joints=joints))
    none = Provenance(np.array(["slow"]), empty, empty, empty, empty, empty)
    change = bone_change(SkeletalAnimation(stretched, none)).value[:, 0]
    np.testing.assert_allclose(change[7], 0.1, atol=1e-5)
    assert np.delete(change, 7).max() < 1e-5
