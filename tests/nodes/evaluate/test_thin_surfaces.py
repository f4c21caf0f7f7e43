"""Some frames of surfaces."""

import numpy as np
import pytest

from reperform.nodes.evaluate.thin_surfaces import thin_surfaces
from reperform.nodes.products.mesh import Surfaces
from reperform.nodes.ragged import Ragged


def test_every_third_frame_from_the_second_at_a_third_of_the_rate():
    whole = Surfaces(
        Ragged([np.full((k + 3, 3), k, np.float32) for k in range(7)]),
        Ragged([np.full((k + 1, 3), k, np.int32) for k in range(7)]),
        np.float32(30),
    )
    some = thin_surfaces(whole, every=3, first=1)
    assert len(some.vertices) == 2
    assert all(np.array_equal(a, b) for a, b in zip(some.vertices, whole.vertices[1::3], strict=True))
    assert all(np.array_equal(a, b) for a, b in zip(some.faces, whole.faces[1::3], strict=True))
    assert float(some.fps) == pytest.approx(10)


def test_a_start_behind_the_end_is_refused():
    whole = Surfaces(
        Ragged([np.full((k + 3, 3), k, np.float32) for k in range(7)]),
        Ragged([np.full((k + 1, 3), k, np.int32) for k in range(7)]),
        np.float32(30),
    )
    with pytest.raises(ValueError, match="under the 7 frames"):
        thin_surfaces(whole, first=7)
