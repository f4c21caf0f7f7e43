import numpy as np
import pytest

from reperform.nodes.kernels.weight_bisection import WeightBisection


def _cut_at_random(corners: int, cuts: int) -> WeightBisection:
    """Cuts wherever a seeded draw falls, with what must be cut first."""
    tree, random = WeightBisection(corners), np.random.default_rng(corners)
    for _ in range(cuts):
        simplex = int(random.choice(tree.leaves))
        while tree.split[simplex] < 0:
            target = simplex
            while conflicts := tree.conflicts(target):
                target = conflicts[0]
            tree.cut(target)
    return tree


@pytest.mark.parametrize("corners", [2, 3, 4])
def test_halves_fill_the_simplex_and_have_half_its_volume(corners):
    tree = _cut_at_random(corners, 12)
    points = np.array(tree.points)
    np.testing.assert_allclose(points.sum(axis=1), 1.0)
    size = {s: abs(np.linalg.det(points[list(tree.corners[s])])) for s in range(len(tree.corners))}
    assert sum(size[s] for s in tree.leaves) == pytest.approx(1.0)
    for s, cut in enumerate(tree.split):
        if cut >= 0:
            assert size[tree.child[s]] == pytest.approx(size[s] / 2)
            assert size[tree.child[s] + 1] == pytest.approx(size[s] / 2)


@pytest.mark.parametrize("corners", [3, 4])
def test_no_point_hangs_on_an_edge(corners):
    """Conforming: no point lies inside an edge of a whole simplex, so that hats are continuous."""
    tree = _cut_at_random(corners, 12)
    points = np.array(tree.points)
    for s in tree.leaves:
        for i, a in enumerate(tree.corners[s]):
            for b in tree.corners[s][:i]:
                middle = 0.5 * (points[a] + points[b])
                assert np.abs(points - middle).max(axis=1).min() > 1e-9


def test_two_corners_are_an_interval_cut_in_halves():
    tree = WeightBisection(2)
    tree.cut(0)
    tree.cut(tree.child[0])
    np.testing.assert_allclose([p[0] for p in tree.points[2:]], [0.5, 0.75])
    np.testing.assert_allclose(sorted(p[0] for p in tree.probes(tree.leaves[0])), [0.125, 0.25, 0.375])
