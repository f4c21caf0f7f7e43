"""Some frames of mattes."""

import numpy as np
import pytest

from reperform.nodes.evaluate.thin_mattes import thin_mattes
from reperform.nodes.products.footage import Mattes


def test_every_third_frame_from_the_second_at_a_third_of_the_rate():
    whole = Mattes(np.arange(7 * 2 * 3 * 4).reshape(7, 2, 3, 4).astype(np.uint8), np.float32(30))
    some = thin_mattes(whole, every=3, first=1)
    assert len(some.alpha) == 2
    assert all(np.array_equal(a, b) for a, b in zip(some.alpha, whole.alpha[1::3], strict=True))
    assert float(some.fps) == pytest.approx(10)


def test_a_start_behind_the_end_is_refused():
    whole = Mattes(np.arange(7 * 2 * 3 * 4).reshape(7, 2, 3, 4).astype(np.uint8), np.float32(30))
    with pytest.raises(ValueError, match="under the 7 frames"):
        thin_mattes(whole, first=7)
