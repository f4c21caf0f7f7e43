import numpy as np
import pytest

from reperform.nodes.blend.hybrid import hybrid
from reperform.nodes.blend.pose import pose
from reperform.nodes.kernels.hybrid_build import nonlinear_blends


def _errors(space, exact, weights):
    return np.linalg.norm(pose(space, weights=weights).vertices - exact(np.array(weights)), axis=2)


def test_two_takes_come_back_to_the_bit_at_both_ends(swing):
    takes = {"a": swing(0.3), "b": swing(1.9)}
    space = hybrid(takes, place=False)
    for weights, take in (((1.0, 0.0), "a"), ((0.0, 1.0), "b")):
        np.testing.assert_array_equal(pose(space, weights=weights).vertices, takes[take].vertices)


@pytest.mark.parametrize("codes", ["int8", "int16"])
def test_the_promised_error_is_kept_at_weights_that_were_not_tried(swing, codes):
    takes = {"a": swing(0.3), "b": swing(2.4)}
    space = hybrid(takes, place=False, epsilon=0.004, codes=codes)
    exact = nonlinear_blends(np.asarray(space.vertices), space.faces)
    assert space.error.max() <= 1.1 * 0.004 + 1e-6
    for w in np.linspace(0.0, 1.0, 38):
        assert (_errors(space, exact, (1.0 - w, w)).max(axis=1) <= space.error + 0.001).all()


def test_more_levels_leave_a_quarter_of_the_error_each(swing):
    takes = {"a": swing(0.3), "b": swing(2.0)}
    spaces = [hybrid(takes, place=False, epsilon=0.0, levels=levels) for levels in (1, 2, 3)]
    assert [len(space.weights) for space in spaces] == [1, 3, 7]
    one, two, three = (space.error.max() for space in spaces)
    # the error of linear interpolation goes with the square of the interval
    assert 3.5 < one / two < 4.5
    assert 3.5 < two / three < 4.5


def test_what_is_below_epsilon_is_not_stored(swing):
    takes = {"a": swing(0.3), "b": swing(1.6)}
    sizes = [hybrid(takes, place=False, epsilon=eps, levels=2).code.size for eps in (0.0, 0.005, 0.02, 1.0)]
    assert sizes == sorted(sizes, reverse=True) and sizes[0] > sizes[1] > sizes[2] > sizes[3] == 0


def test_three_takes_span_a_triangle_whose_sides_are_the_pairs(swing):
    axis = np.array([1.0, 0.3, 0.2])
    takes = {"a": swing(0.2), "b": swing(1.7), "c": swing(1.3, axis)}
    space = hybrid(takes, place=False, epsilon=0.004)
    exact = nonlinear_blends(np.asarray(space.vertices), space.faces)
    random = np.random.default_rng(3)
    for weights in random.dirichlet(np.ones(3), 25):
        assert (_errors(space, exact, tuple(weights)).max(axis=1) <= space.error + 0.0015).all()
    side = hybrid({"a": takes["a"], "c": takes["c"]}, place=False, epsilon=0.004)
    across = nonlinear_blends(np.asarray(side.vertices), side.faces)
    np.testing.assert_allclose(exact(np.array([0.7, 0.0, 0.3])), across(np.array([0.7, 0.3])), atol=1e-6)
    for k in range(3):
        weights = tuple(np.eye(3)[k])
        np.testing.assert_array_equal(pose(space, weights=weights).vertices, list(takes.values())[k].vertices)


def test_four_takes_blend_without_jumps(swing):
    axes = np.random.default_rng(1).normal(size=(4, 3))
    takes = {str(k): swing(0.4 + 0.4 * k, axis) for k, axis in enumerate(axes)}
    space = hybrid(takes, place=False, epsilon=0.03, deepest=2)
    random = np.random.default_rng(5)
    for start, end in zip(random.dirichlet(np.ones(4), 6), random.dirichlet(np.ones(4), 6), strict=True):
        way = [
            pose(space, weights=tuple((1 - s) * start + s * end)).vertices for s in np.linspace(0.0, 1.0, 101)
        ]
        steps = np.linalg.norm(np.diff(way, axis=0), axis=3).max(axis=(1, 2))
        # a hundredth of the way is never more than a few hundredths of the distance
        assert steps.max() < 0.06


def test_the_order_of_takes_has_no_say(swing):
    takes = {"a": swing(0.2), "b": swing(1.7), "c": swing(1.3, np.array([1.0, 0.3, 0.2]))}
    turned = {name: takes[name] for name in ("c", "a", "b")}
    exact = [
        nonlinear_blends(np.stack([take.vertices for take in order.values()]), takes["a"].faces)
        for order in (takes, turned)
    ]
    # the operator is that of the first take, so compare with one operator: the same first pose
    one, other = exact[0](np.array([0.2, 0.5, 0.3])), exact[1](np.array([0.3, 0.2, 0.5]))
    np.testing.assert_allclose(one, other, atol=1e-5)


def test_takes_of_other_topology_rate_or_number_are_refused(swing):
    take = swing(0.3)
    with pytest.raises(ValueError, match="two or more takes"):
        hybrid({"a": take})
    with pytest.raises(ValueError, match="b differs from a: align"):
        hybrid({"a": take, "b": take._replace(faces=take.faces[::-1])})
    with pytest.raises(ValueError, match=r"25\.0 Hz, b 50\.0 Hz"):
        hybrid({"a": take, "b": take._replace(fps=np.asarray(50.0, np.float32))})
