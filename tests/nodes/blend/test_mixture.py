import numpy as np
import pytest

from reperform.nodes.blend.mixture import mixture
from reperform.nodes.blend.nonlinear import nonlinear


def test_two_takes_blend_as_the_pair_does(swing):
    takes = {"a": swing(0.4), "b": swing(1.8)}
    pair = nonlinear((takes["a"], takes["b"]), weight=0.3, place=False).vertices
    np.testing.assert_allclose(mixture(takes, weights=(0.7, 0.3), place=False).vertices, pair, atol=1e-5)
    linear = mixture(takes, method="linear", place=False).vertices
    np.testing.assert_allclose(linear, 0.5 * (takes["a"].vertices + takes["b"].vertices), atol=1e-6)


def test_the_order_of_three_takes_has_no_say_and_one_alone_is_itself(swing):
    takes = {"a": swing(0.4), "b": swing(1.8), "c": swing(1.1, np.array([1.0, 0.2, 0.1]))}
    one = mixture(takes, weights=(0.2, 0.5, 0.3), place=False).vertices
    # the first pose of the first take is the reference of the operator: keep it first
    other = mixture(takes, takes=("a", "c", "b"), weights=(0.2, 0.3, 0.5), place=False).vertices
    np.testing.assert_allclose(one, other, atol=1e-6)
    alone = mixture(takes, weights=(0.0, 0.0, 1.0), place=False).vertices
    np.testing.assert_allclose(alone, takes["c"].vertices, atol=1e-6)


def test_weights_that_do_not_fit_are_refused(swing):
    takes = {"a": swing(0.4), "b": swing(1.8)}
    for weights in ((1.0,), (0.4, 0.4), (1.5, -0.5)):
        with pytest.raises(ValueError, match=r"one weight per take \(a, b\) needed"):
            mixture(takes, weights=weights)
    with pytest.raises(ValueError, match="no take 'c'"):
        mixture(takes, takes=("a", "c"))
