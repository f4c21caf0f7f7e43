import numpy as np
import pytest

from reperform.nodes.blend.hybrid import hybrid
from reperform.nodes.blend.pose import pose


def test_small_differences_blend_linearly(swing):
    takes = {"a": swing(0.30), "b": swing(0.34)}
    space = hybrid(takes, place=False)
    assert space.code.size == 0
    blended = pose(space, weights=(0.25, 0.75)).vertices
    expected = 0.25 * takes["a"].vertices + 0.75 * takes["b"].vertices
    np.testing.assert_allclose(blended, expected, atol=1e-6)


def test_weights_that_are_none_are_refused(swing):
    space = hybrid({"a": swing(0.30), "b": swing(0.34)}, place=False)
    with pytest.raises(ValueError, match=r"one weight per take needed \(a, b\), got 3"):
        pose(space, weights=(0.2, 0.3, 0.5))
    with pytest.raises(ValueError, match="with sum 1, got"):
        pose(space, weights=(0.2, 0.3))
    with pytest.raises(ValueError, match=">= 0"):
        pose(space, weights=(1.2, -0.2))
