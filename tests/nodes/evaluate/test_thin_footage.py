"""Some frames of footage."""

import numpy as np
import pytest

from reperform.nodes.evaluate.thin_footage import thin_footage
from reperform.nodes.products.footage import Footage


def test_every_third_frame_from_the_second_at_a_third_of_the_rate():
    whole = Footage(np.arange(7 * 2 * 3 * 4 * 3).reshape(7, 2, 3, 4, 3).astype(np.uint8), np.float32(30))
    some = thin_footage(whole, every=3, first=1)
    assert len(some.images) == 2
    assert all(np.array_equal(a, b) for a, b in zip(some.images, whole.images[1::3], strict=True))
    assert float(some.fps) == pytest.approx(10)


def test_a_start_behind_the_end_is_refused():
    whole = Footage(np.arange(7 * 2 * 3 * 4 * 3).reshape(7, 2, 3, 4, 3).astype(np.uint8), np.float32(30))
    with pytest.raises(ValueError, match="under the 7 frames"):
        thin_footage(whole, first=7)
