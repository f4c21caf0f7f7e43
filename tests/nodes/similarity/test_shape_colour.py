import numpy as np
import ot
import pytest

from reperform.nodes.products.shape_colour import ShapeColourHistograms
from reperform.nodes.ragged import Ragged
from reperform.nodes.similarity.shape_colour import shape_colour, shape_colour_signatures


def _take(seed, frames, entries=40):
    rng = np.random.default_rng(seed)
    counts = entries + rng.integers(0, 5, frames)
    share = [rng.random(n) + 0.01 for n in counts]
    return ShapeColourHistograms(
        Ragged([np.arange(n, dtype=np.int32) for n in counts]),
        Ragged([s / s.sum() for s in share]),
        Ragged([(rng.normal(size=(n, 3)) * (0.2, 0.5, 0.3)).astype(np.float32) for n in counts]),
        Ragged([rng.random((n, 3)).astype(np.float32) for n in counts]),
        np.zeros((frames, 3), np.float32),
        np.array([5, 10, 20, 10, 10, 10], np.int32),
        np.float32(1.2),
    )


def _turned(take, yaw):
    c, s = np.cos(yaw), np.sin(yaw)
    turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return take._replace(point=Ragged([(p @ turn.T).astype(np.float32) for p in take.point]))


def _turn_points(points, yaw):
    c, s = np.cos(yaw), np.sin(yaw)
    x, z = points[:, 0], points[:, 2]
    return np.column_stack([c * x + s * z, points[:, 1], -s * x + c * z, points[:, 3:]])


def test_all_bins_are_the_exact_distance_over_all_turns():
    a, b = _take(0, 2), _take(1, 3)
    distance = shape_colour((a, b), clusters=0, turns=5, colour_weight=0.7).distance
    x, y = (shape_colour_signatures(take, 0.7) for take in (a, b))
    for i, j in ((0, 0), (1, 2)):
        p, q = slice(x.first[i], x.first[i + 1]), slice(y.first[j], y.first[j + 1])
        costs = [
            np.linalg.norm(x.point[p][:, None] - _turn_points(y.point[q], 2 * np.pi * k / 5)[None], axis=2)
            for k in range(5)
        ]
        truth = min(ot.emd2(x.mass[p], y.mass[q], cost) for cost in costs)
        np.testing.assert_allclose(distance[i, j], truth, rtol=1e-6)


def test_zero_for_a_turned_copy_and_symmetric():
    a = _take(2, 3)
    turned = _turned(a, 2 * np.pi * 7 / 20)
    assert np.abs(np.diag(shape_colour((a, turned), clusters=0).distance)).max() < 1e-6
    b = _take(3, 2)
    np.testing.assert_allclose(
        shape_colour((a, b), clusters=0).distance, shape_colour((b, a), clusters=0).distance.T, rtol=1e-5
    )


def test_a_take_with_itself_is_what_it_is_with_a_copy():
    a = _take(4, 4)
    same = shape_colour((a, a), clusters=12).distance
    np.testing.assert_array_equal(np.diag(same), 0)
    np.testing.assert_array_equal(same, same.T)
    copy = a._replace(share=Ragged([s * 1.0000000001 for s in a.share]))
    other = shape_colour((a, copy), clusters=12).distance
    np.testing.assert_allclose(np.triu(other), np.triu(same), atol=1e-5)


def test_clusters_are_within_the_bound_and_approach_the_exact():
    a, b = _take(5, 3, 60), _take(6, 3, 60)
    exact = shape_colour((a, b), clusters=0, turns=1).distance
    errors = [np.abs(shape_colour((a, b), clusters=n, turns=1).distance - exact).mean() for n in (2, 16, 400)]
    assert errors[0] > errors[1] > errors[2]


def test_colours_count_by_their_weight():
    a = _take(7, 2)
    other = a._replace(colour=Ragged([c[:, ::-1].copy() for c in a.colour]))
    assert np.diag(shape_colour((a, other), colour_weight=0.0, clusters=0, turns=1).distance).max() < 1e-7
    assert np.diag(shape_colour((a, other), clusters=0, turns=1).distance).min() > 0.05


def test_refuses_different_bins():
    a = _take(0, 2)
    with pytest.raises(ValueError, match="one set of bins"):
        shape_colour((a, a._replace(reach=np.float32(1.0))))
