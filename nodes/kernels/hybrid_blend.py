"""Blended meshes from linear blending and sparse corrections, evaluated without allocation."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit


class HybridFields(NamedTuple):
    """N inputs of T poses, and corrections at K bisected weights. Plain arrays: usable in compiled code.

    The weights' simplex is halved again and again: simplex s has the correction `split[s]` at the middle of one
    edge and the two halves child[s], child[s] + 1; split is -1 where it is whole. Correction k of pose t is worth
    step[k, t] code, on the runs start[k T + t] .. start[k T + t + 1] of coordinates; elsewhere it is nothing.
    """

    # (N, T, 3 V) float32, m
    inputs: np.ndarray
    split: np.ndarray
    child: np.ndarray
    start: np.ndarray
    # per run: its first coordinate (3 v + axis), and where its codes start; one entry more at the end
    first: np.ndarray
    begin: np.ndarray
    # int8 or int16
    code: np.ndarray
    step: np.ndarray


def new_scratch(fields: HybridFields) -> np.ndarray:
    """What one caller at a time needs to evaluate."""
    return np.empty(len(fields.inputs))


@njit(cache=True, nogil=True, error_model="numpy")
def evaluate(
    fields: HybridFields, pose: int, weights: np.ndarray, out: np.ndarray, scratch: np.ndarray
) -> None:
    """Write the blend of one pose at weights (N,), not negative and of sum 1, into out (V, 3) float32, m.

        x(w) = sum_i w_i x_i + sum_k h_k(w) d_k

    where h_k is 1 at the bisected weights of correction k, 0 at those of all earlier ones, and linear on every
    simplex between. An input (a weight of 1) comes back to the bit. Not more than depth corrections are met.

    Source: Casas, Tejera, Guillemaut and Hilton 2013, IEEE TVCG (001 eq 3; 004 eq 3.8). Departure: corrections
    are hierarchical (Yserentant 1986, Numerische Mathematik): each is what the coarser ones leave, which is
    small, so that few vertices need it.
    """
    _blend(fields, pose, weights, 1.0, out.reshape(-1), scratch)


@njit(cache=True, nogil=True, error_model="numpy")
def evaluate_mix(
    fields: HybridFields,
    before: int,
    after: int,
    part: float,
    weights: np.ndarray,
    out: np.ndarray,
    scratch: np.ndarray,
) -> None:
    """As `evaluate`, between two poses: 1 - part of `before` and part of `after` (the first pose of a cycle, say)."""
    flat = out.reshape(-1)
    if part == 0.0 or part == 1.0:
        _blend(fields, after if part == 1.0 else before, weights, 1.0, flat, scratch)
        return
    _blend(fields, before, weights, 1.0 - part, flat, scratch)
    _linear(fields.inputs, after, weights, part, 0, True, flat)
    _correct(fields, after, weights, part, flat, scratch)


@njit(cache=True, nogil=True, error_model="numpy")
def correct_between(
    fields: HybridFields,
    before: int,
    after: int,
    part: float,
    weights: np.ndarray,
    share: float,
    flat: np.ndarray,
    scratch: np.ndarray,
) -> None:
    """Add `share` of the corrections alone, between two poses, to coordinates flat (3 V,); inputs are not read."""
    if part < 1.0:
        _correct(fields, before, weights, share * (1.0 - part), flat, scratch)
    if part > 0.0:
        _correct(fields, after, weights, share * part, flat, scratch)


@njit(cache=True, nogil=True, error_model="numpy")
def evaluate_between(
    fields: HybridFields, time: float, weights: np.ndarray, out: np.ndarray, scratch: np.ndarray
) -> None:
    """As `evaluate`, at a time between two poses (in poses, kept within the take): linear from one to the next."""
    last = fields.inputs.shape[1] - 1
    time = min(max(time, 0.0), float(last))
    before = min(int(time), max(last - 1, 0))
    evaluate_mix(fields, before, min(before + 1, last), time - before, weights, out, scratch)


@njit(cache=True, nogil=True, error_model="numpy")
def linear_into(fields: HybridFields, pose: int, weights: np.ndarray, out: np.ndarray) -> None:
    """Write the weighted mean of the inputs of one pose into out (V, 3) float32, m."""
    _linear(fields.inputs, pose, weights, 1.0, 0, False, out.reshape(-1))


@njit(cache=True, nogil=True, error_model="numpy")
def hat_values(
    fields: HybridFields, weights: np.ndarray, node: np.ndarray, value: np.ndarray, scratch: np.ndarray
) -> int:
    """Which corrections count at weights (N,), and how much; returns how many."""
    scratch[:] = weights
    simplex, depth, one, hat = _next_hat(fields, 0, 0, scratch)
    found = 0
    while one >= 0:
        node[found], value[found] = one, hat
        found += 1
        simplex, depth, one, hat = _next_hat(fields, simplex, depth, scratch)
    return found


@njit(cache=True, nogil=True, error_model="numpy")
def _next_hat(
    fields: HybridFields, simplex: int, depth: int, inside: np.ndarray
) -> tuple[int, int, int, float]:
    """Go down from a simplex past the next correction that counts: simplex and depth there, correction, hat.

    inside (N,): barycentric coordinates, overwritten. The correction is -1 where none is left.
    """
    n = len(inside) - 1
    while fields.split[simplex] >= 0:
        k = n - depth % n
        node, low = fields.split[simplex], min(inside[0], inside[k])
        simplex = fields.child[simplex] + _halve(inside, k)
        depth += 1
        if low > 0.0:
            return simplex, depth, node, 2.0 * low
    return simplex, depth, -1, 0.0


@njit(cache=True, nogil=True, error_model="numpy")
def _halve(inside: np.ndarray, k: int) -> int:
    """Barycentric coordinates in the half of the simplex (edge 0 - k cut) that they lie in; which half it is."""
    if inside[0] >= inside[k]:
        inside[0] -= inside[k]
        inside[k] *= 2.0
        return 0
    rest, middle = inside[k] - inside[0], 2.0 * inside[0]
    for j in range(k - 1):
        inside[j] = inside[j + 1]
    inside[k - 1], inside[k] = rest, middle
    return 1


@njit(cache=True, nogil=True, error_model="numpy")
def _blend(
    fields: HybridFields, pose: int, weights: np.ndarray, share: float, flat: np.ndarray, scratch: np.ndarray
) -> None:
    """flat = share times the blend of one pose; two inputs and the coarsest correction, most of it, in one pass."""
    scratch[:] = weights
    simplex, depth, node, hat = _next_hat(fields, 0, 0, scratch)
    if node < 0:
        _linear(fields.inputs, pose, weights, share, 0, False, flat)
        return
    # where a correction counts, two inputs do
    i = _used(weights, 0)
    j = _used(weights, i + 1)
    one, two = np.float32(share * weights[i]), np.float32(share * weights[j])
    _corrected_pair(
        fields, pose, node, i, j, one, two, np.float32(hat * share * fields.step[node, pose]), flat
    )
    if _used(weights, j + 1) < len(weights):
        _linear(fields.inputs, pose, weights, share, j + 1, True, flat)
    if fields.split[simplex] >= 0:
        _correct_below(fields, pose, simplex, depth, share, flat, scratch)


@njit(cache=True, nogil=True, error_model="numpy")
def _corrected_pair(
    fields: HybridFields, pose: int, node: int, i: int, j: int, one: float, two: float, scale: float,
    flat: np.ndarray,
) -> None:  # fmt: skip
    """flat = one x_i + two x_j + scale code of one correction: each coordinate is written once."""
    x, y, code = fields.inputs[i, pose], fields.inputs[j, pose], fields.code
    row, done = node * fields.inputs.shape[1] + pose, np.uint64(0)
    for run in range(fields.start[row], fields.start[row + 1]):
        # unsigned, so that the loops are known not to count from the end and are vectorised
        start = np.uint64(fields.first[run])
        shift = np.uint64(fields.begin[run]) - start
        end = np.uint64(fields.begin[run + 1]) - shift
        for v in range(done, start):
            flat[v] = one * x[v] + two * y[v]
        for v in range(start, end):
            flat[v] = one * x[v] + two * y[v] + scale * np.float32(code[v + shift])
        done = end
    for v in range(done, np.uint64(len(flat))):
        flat[v] = one * x[v] + two * y[v]


@njit(cache=True, nogil=True, error_model="numpy")
def _linear(
    inputs: np.ndarray, pose: int, weights: np.ndarray, share: float, first: int, add: bool, flat: np.ndarray
) -> None:
    """flat (+)= share * sum_(i >= first) w_i inputs[i, pose], two at a time; those of weight 0 are not read."""
    i, fresh = _used(weights, first), not add
    while i < len(weights):
        j = _used(weights, i + 1)
        one, x = np.float32(share * weights[i]), inputs[i, pose]
        if j < len(weights):
            two, y = np.float32(share * weights[j]), inputs[j, pose]
            if fresh:
                for v in range(len(flat)):
                    flat[v] = one * x[v] + two * y[v]
            else:
                for v in range(len(flat)):
                    flat[v] += one * x[v] + two * y[v]
        elif fresh:
            for v in range(len(flat)):
                flat[v] = one * x[v]
        else:
            for v in range(len(flat)):
                flat[v] += one * x[v]
        fresh = False
        i = _used(weights, j + 1)


@njit(cache=True, nogil=True, error_model="numpy")
def _used(weights: np.ndarray, i: int) -> int:
    """The first input from i on whose weight is not 0."""
    while i < len(weights) and weights[i] == 0.0:
        i += 1
    return i


@njit(cache=True, nogil=True, error_model="numpy")
def _correct(
    fields: HybridFields, pose: int, weights: np.ndarray, share: float, flat: np.ndarray, scratch: np.ndarray
) -> None:
    """flat += share * sum_k h_k(w) d_k of one pose."""
    scratch[:] = weights
    _correct_below(fields, pose, 0, 0, share, flat, scratch)


@njit(cache=True, nogil=True, error_model="numpy")
def _correct_below(
    fields: HybridFields,
    pose: int,
    simplex: int,
    depth: int,
    share: float,
    flat: np.ndarray,
    inside: np.ndarray,
) -> None:
    """flat += share * sum_k h_k d_k of those corrections that are found from a simplex down."""
    first, begin, code = fields.first, fields.begin, fields.code
    simplex, depth, node, hat = _next_hat(fields, simplex, depth, inside)
    while node >= 0:
        row = node * fields.inputs.shape[1] + pose
        scale = np.float32(hat * share * fields.step[node, pose])
        for run in range(fields.start[row], fields.start[row + 1]):
            # unsigned, so that the loop is known not to count from the end and is vectorised
            start = np.uint64(first[run])
            shift = np.uint64(begin[run]) - start
            for v in range(start, np.uint64(begin[run + 1]) - shift):
                flat[v] += scale * np.float32(code[v + shift])
        simplex, depth, node, hat = _next_hat(fields, simplex, depth, inside)
