"""The volume of a solid with a known one."""

import numpy as np
import pytest
import trimesh

from reperform.nodes.evaluate.volume import volume
from reperform.nodes.products.mesh import MeshSequence, Surfaces

BOX = trimesh.creation.box([0.4, 1.7, 0.3])


def test_a_box_off_the_origin():
    vertices = (BOX.vertices + [3.1, -0.4, 2.2]).astype(np.float32)
    faces = BOX.faces.astype(np.int32)
    for wired in (
        {"surfaces": Surfaces(vertices, faces, np.float32(25))},
        {"mesh": MeshSequence(vertices, faces, np.float32(25))},
    ):
        found = volume(**wired)
        assert found.value == pytest.approx([0.4 * 1.7 * 0.3], rel=1e-5)
        assert found.unit.tolist() == ["m^3"]


def test_one_surface_must_be_wired():
    with pytest.raises(ValueError, match=r"evaluate\.volume: exactly one"):
        volume()
