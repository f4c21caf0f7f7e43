import numpy as np
import pytest
from scipy.spatial.distance import directed_hausdorff

from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.kernels.overlap_distance import hausdorff, overlap_distance
from reperform.nodes.kernels.path_frames import Passage

POINTS = np.random.default_rng(3).normal(size=(40, 3)) * [0.3, 0.9, 0.2]


def test_hausdorff_agrees_with_scipy() -> None:
    other = np.random.default_rng(4).normal(size=(55, 3)) * [0.4, 0.8, 0.3]
    expected = max(directed_hausdorff(POINTS, other)[0], directed_hausdorff(other, POINTS)[0])
    assert hausdorff(POINTS, other) == pytest.approx(expected)
    assert hausdorff(other, POINTS) == pytest.approx(expected)


def test_where_one_take_is_a_placed_copy_of_the_other_nothing_is_apart() -> None:
    source = POINTS + 0.05 * np.arange(12)[:, None, None]
    placement = Placement(0.8, np.array([0.3, -1.2]))
    back = Placement(-0.8, np.zeros(2))
    moved = source.copy()
    moved[..., [0, 2]] -= placement.offset
    target = apply(moved, back)
    passage = Passage(0, 1, 6, 6, 4, placement)
    assert overlap_distance(passage, [source, target], 9) == pytest.approx(0.0, abs=1e-12)


def test_weights_fall_from_the_middle() -> None:
    # the target sinks by 1 cm per frame from the middle on: |k| cm at k, weights 3 - |k|
    source = np.repeat(POINTS[None], 9, axis=0)
    target = source.copy()
    target[:, :, 1] += 1e-4 * np.abs(np.arange(9) - 4)[:, None]
    passage = Passage(0, 1, 4, 4, 3, Placement(0.0, np.zeros(2)))
    expected = 1e-4 * (0 * 3 + 2 * 1 * 2 + 2 * 2 * 1) / (3 + 2 * 2 + 2 * 1)
    assert overlap_distance(passage, [source, target], 9) == pytest.approx(expected)
