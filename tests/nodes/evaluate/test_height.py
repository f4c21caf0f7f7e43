"""The height of a solid with a known one."""

import numpy as np
import pytest
import trimesh

from reperform.nodes.evaluate.height import height
from reperform.nodes.products.mesh import Surfaces


def test_the_vertical_extent_counts_not_the_top():
    ball = trimesh.creation.icosphere(3)
    vertices = (ball.vertices * [0.5, 0.8, 0.3] + [0.2, 1.4, -3]).astype(np.float32)
    found = height(surfaces=Surfaces(vertices, ball.faces.astype(np.int32), np.float32(25)))
    assert found.value == pytest.approx([1.6], rel=1e-5)


def test_one_surface_must_be_wired():
    with pytest.raises(ValueError, match=r"evaluate\.height: exactly one"):
        height()
