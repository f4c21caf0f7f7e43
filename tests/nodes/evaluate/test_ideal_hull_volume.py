"""The ideal hull of a solid whose hull is known."""

import numpy as np
import pytest
import trimesh

from reperform.nodes.evaluate.ideal_hull_volume import ideal_hull_volume
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.studio.rig import rig

FPS = np.float32(25)


def test_a_sphere_seen_all_round_is_nearly_its_own_hull_and_more_cameras_help():
    ball = trimesh.creation.icosphere(4)
    truth = MeshSequence(
        (0.4 * ball.vertices + [0.1, 0.9, -0.15]).astype(np.float32), ball.faces.astype(np.int32), FPS
    )
    true = 4 / 3 * np.pi * 0.4**3
    few, many = (
        ideal_hull_volume(truth, rig(cameras=count, width=480, picture_height=270), voxel=0.01).value[0]
        / true
        for count in (4, 8)
    )
    assert 1.0 < many < few < 1.4
    assert many < 1.13


def test_nothing_is_under_the_floor():
    ball = trimesh.creation.icosphere(3)
    truth = MeshSequence(
        (0.4 * ball.vertices + [0, 0.1, 0]).astype(np.float32), ball.faces.astype(np.int32), FPS
    )
    cameras = rig(cameras=4, width=240, picture_height=135)
    above = ideal_hull_volume(truth, cameras, voxel=0.02)
    all_of_it = ideal_hull_volume(truth, cameras, voxel=0.02, floor=-2.0)
    assert above.value[0] < 0.75 * all_of_it.value[0]


def test_pictures_of_two_sizes_are_refused():
    cameras = rig(cameras=2, width=64, picture_height=36)
    odd = cameras._replace(image_size=np.array([[64, 36], [36, 64]], np.int32))
    ball = trimesh.creation.icosphere(1)
    with pytest.raises(ValueError, match="one size"):
        ideal_hull_volume(
            MeshSequence(ball.vertices.astype(np.float32), ball.faces.astype(np.int32), FPS), odd
        )
