"""Some frames of mesh."""

import numpy as np
import pytest

from reperform.nodes.evaluate.thin_mesh import thin_mesh
from reperform.nodes.products.mesh import MeshSequence


def test_every_third_frame_from_the_second_at_a_third_of_the_rate():
    whole = MeshSequence(
        np.arange(7 * 6, dtype=np.float32).reshape(7, 2, 3), np.array([[0, 1, 0]], np.int32), np.float32(30)
    )
    some = thin_mesh(whole, every=3, first=1)
    assert len(some.vertices) == 2
    assert all(np.array_equal(a, b) for a, b in zip(some.vertices, whole.vertices[1::3], strict=True))
    assert float(some.fps) == pytest.approx(10)


def test_a_start_behind_the_end_is_refused():
    whole = MeshSequence(
        np.arange(7 * 6, dtype=np.float32).reshape(7, 2, 3), np.array([[0, 1, 0]], np.int32), np.float32(30)
    )
    with pytest.raises(ValueError, match="under the 7 frames"):
        thin_mesh(whole, first=7)
