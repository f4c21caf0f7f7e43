from collections.abc import Mapping

import numpy as np

from reperform.nodes.products.mocap import Mocap, SkeletalAnimation
from reperform.nodes.products.motion import Provenance
from reperform.nodes.skeleton.bone_animation import bone_animation


def test_joints_become_vertices_and_the_provenance_comes_along(striders: Mapping[str, Mocap]) -> None:
    take, count = striders["slow"], len(striders["slow"].skeleton.joints)
    frames = np.tile(np.arange(count, dtype=np.int32)[:, None], (1, 2))
    weight = np.tile(np.array([1.0, 0.0], np.float32), (count, 1))
    source = Provenance(
        np.array(["slow"]), 0 * frames, frames, weight, np.zeros((count, 2)), np.zeros((count, 2, 2))
    )
    made = bone_animation(SkeletalAnimation(take, source))
    np.testing.assert_array_equal(made.mesh.vertices, take.skeleton.joints)
    assert len(made.mesh.faces) == len(take.skeleton.parents) - 1
    assert made.provenance is source
