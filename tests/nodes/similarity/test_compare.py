import numpy as np
import pytest

from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.similarity.compare import compare


def _pairs(seed, frames={"walk": 14, "jog": 17}):  # noqa: B006
    rng = np.random.default_rng(seed)
    return {
        (a, b): Dissimilarity(rng.random((m, n)).astype(np.float32))
        for a, m in frames.items()
        for b, n in frames.items()
    }


def test_matrices_stand_take_after_take_and_transitions_are_of_least_cost():
    measures = [_pairs(k) for k in range(4)]
    found = compare(*measures, transitions=2, half_length=3, apart=4)
    assert found.distance.shape == (4, 31, 31)
    np.testing.assert_array_equal(found.distance[2, 14:, :14], measures[2]["jog", "walk"].distance)
    chosen = np.flatnonzero((found.measure == 1) & (found.source == 0) & (found.target == 1))
    assert len(chosen) == 2
    d = measures[1]["walk", "jog"].distance
    costs = {
        (m, n): sum((3 - abs(k)) * d[m + k, n + k] for k in (-2, -1, 0, 1, 2)) / 9
        for m in range(3, 11)
        for n in range(3, 14)
    }
    best = min(costs, key=costs.__getitem__)
    assert (found.source_frame[chosen[0]], found.target_frame[chosen[0]]) == best
    np.testing.assert_allclose(found.cost[chosen[0]], costs[best], rtol=1e-5)
    inside = (found.source == 0) & (found.target == 0)
    assert (np.abs(found.source_frame - found.target_frame)[inside] >= 4).all()


def test_refuses_measures_of_other_frames():
    a = _pairs(0)
    with pytest.raises(ValueError, match="must compare walk with walk, 14 x 14 frames"):
        compare(a, _pairs(1, {"walk": 13, "jog": 17}), a, a)


def test_deformation_gradients_are_a_fifth_measure():
    measures = [_pairs(k) for k in range(5)]
    four, five = compare(*measures[:4]), compare(*measures)
    assert five.measures.tolist() == [*four.measures.tolist(), "deformation gradient"]
    np.testing.assert_array_equal(five.distance[:4], four.distance)
    np.testing.assert_array_equal(five.distance[4, :14, 14:], measures[4]["walk", "jog"].distance)
