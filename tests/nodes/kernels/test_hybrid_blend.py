import numpy as np
import pytest

from reperform.nodes.kernels.hybrid_blend import (
    correct_between,
    evaluate,
    evaluate_between,
    evaluate_mix,
    hat_values,
    linear_into,
    new_scratch,
)
from reperform.nodes.kernels.hybrid_build import build_hybrid


def _curved(inputs):
    """A blend that is not linear: every vertex is lifted by a product of weights of its own."""
    lift = np.random.default_rng(8).normal(size=inputs.shape[1:]) * 0.2

    def exact(weights):
        bend = 1.0 - float(np.sum(np.square(weights)))
        return np.einsum("n,ntvk->tvk", weights, inputs) + bend * lift

    return exact


@pytest.fixture(params=[2, 3, 4])
def inputs(request):
    return np.random.default_rng(request.param).normal(size=(request.param, 3, 50, 3)).astype(np.float32)


def _at(fields, weights, pose=1):
    out = np.empty((fields.inputs.shape[2] // 3, 3), np.float32)
    evaluate(fields, pose, np.asarray(weights), out, new_scratch(fields))
    return out


def test_it_is_exact_at_inputs_and_at_bisected_weights(inputs):
    exact = _curved(inputs)
    built = build_hybrid(inputs, exact, 0.0, 1, 1)
    count = len(inputs)
    assert len(built.weights) >= count * (count - 1) // 2
    for k in range(count):
        np.testing.assert_array_equal(_at(built.fields, np.eye(count)[k]), inputs[k, 1])
    for weights in built.weights:
        np.testing.assert_allclose(_at(built.fields, weights), exact(weights)[1], atol=1e-4)


def test_hats_are_those_of_finite_elements(inputs):
    """h_k is 1 at its own weights and 0 at all earlier ones; linear functions need no correction."""
    built = build_hybrid(inputs, _curved(inputs), 0.0, 2, 2)
    node, value = np.empty(64, np.int64), np.empty(64)
    for k, weights in enumerate(built.weights):
        found = hat_values(built.fields, weights, node, value, new_scratch(built.fields))
        hats = dict(zip(node[:found].tolist(), value[:found].tolist(), strict=True))
        assert hats[k] == pytest.approx(1.0) and all(earlier <= k for earlier in hats)
    straight = build_hybrid(inputs, lambda w: np.einsum("n,ntvk->tvk", w, inputs), 1e-4, 2, 2)
    assert straight.fields.code.size == 0


def test_between_poses_and_weights_the_blend_is_continuous(inputs):
    fields = build_hybrid(inputs, _curved(inputs), 0.0, 2, 2).fields
    out, scratch = np.empty((50, 3), np.float32), new_scratch(fields)
    weights = np.random.default_rng(0).dirichlet(np.ones(len(inputs)))
    evaluate_between(fields, 1.25, weights, out, scratch)
    np.testing.assert_allclose(
        out, 0.75 * _at(fields, weights, 1) + 0.25 * _at(fields, weights, 2), atol=1e-5
    )
    for time, pose in ((-3.0, 0), (1.0, 1), (2.0, 2), (9.0, 2)):
        evaluate_between(fields, time, weights, out, scratch)
        np.testing.assert_array_equal(out, _at(fields, weights, pose))
    near = weights + 1e-7 * (np.eye(len(inputs))[0] - weights)
    np.testing.assert_allclose(_at(fields, near), _at(fields, weights), atol=1e-5)


def test_linear_is_the_weighted_mean(inputs):
    fields = build_hybrid(inputs, _curved(inputs), 0.0, 1, 1).fields
    weights, out = np.random.default_rng(2).dirichlet(np.ones(len(inputs))), np.empty((50, 3), np.float32)
    linear_into(fields, 2, weights, out)
    np.testing.assert_allclose(out, np.einsum("n,nvk->vk", weights, inputs[:, 2]), atol=1e-6)


def test_codes_err_by_half_a_step(inputs):
    exact = _curved(inputs)
    for codes, bits in (("int8", 7), ("int16", 15)):
        built = build_hybrid(inputs, exact, 0.0, 1, 1, codes)
        step = float(built.fields.step.max())
        assert step < 1.0 / 2**bits
        error = max(np.abs(_at(built.fields, w) - exact(w)[1]).max() for w in built.weights)
        assert error <= 0.5 * step * 1.01 + 1e-6


@pytest.mark.parametrize("epsilon", [0.0, 0.2])
def test_one_pass_writes_what_linear_blending_and_corrections_add_up_to(inputs, epsilon):
    fields = build_hybrid(inputs, _curved(inputs), epsilon, 2, 2).fields
    scratch, rng = new_scratch(fields), np.random.default_rng(5)
    one, two = np.empty((2, *inputs.shape[2:]), np.float32)
    lifted = 0
    # sparse: runs have gaps before, between or after them
    assert epsilon == 0.0 or 0 < fields.code.size < 0.9 * fields.step.size * fields.inputs.shape[2]
    for weights in [*rng.dirichlet(np.ones(len(inputs)), 20), np.eye(len(inputs))[1]]:
        evaluate(fields, 2, weights, one, scratch)
        linear_into(fields, 2, weights, two)
        lifted += not np.array_equal(one, two)
        correct_between(fields, 2, 0, 0.0, weights, 1.0, two.reshape(-1), scratch)
        np.testing.assert_allclose(one, two, rtol=0.0, atol=0.0 if len(inputs) == 2 else 1e-6)
        evaluate_mix(fields, 2, 0, 0.4, weights, one, scratch)
        np.testing.assert_allclose(one, 0.6 * two + 0.4 * _at(fields, weights, 0), atol=2e-6)
    assert lifted > 15
