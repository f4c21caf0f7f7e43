"""Time and memory of a blend space."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Annotated

import numpy as np
from numba import njit

from reperform.nodes.blend.space_fields import hybrid_fields
from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.hybrid_blend import HybridFields, evaluate, linear_into, new_scratch
from reperform.nodes.kernels.hybrid_build import stored_bytes
from reperform.nodes.products.blend_space import BlendSpace
from reperform.nodes.products.measures import Measures


@node(over="dataset", volatile=True)
def space_times(
    space: BlendSpace,
    *,
    repeats: Annotated[int, Param("1", 1, 1000, "how often each is timed")] = 51,
) -> Measures:
    """Seconds per frame of playing a blend space once through at nine weights, in compiled code on one thread.

    Entries `hybrid` and `linear` (s; the same loop without corrections, in the same style), `hybrid / linear`,
    `memory` (stored corrections over dense float32 ones; 0 where there are none) and `error` (m). The two
    alternate after a round that does not count, into the same mesh; the median time of each is told.

    Source: 004 table 3.1 and fig 3.12.
    """
    fields = hybrid_fields(space)
    weights = _weights(len(fields.inputs))
    out, scratch = np.empty(np.shape(space.vertices)[2:], np.float32), new_scratch(fields)
    hybrid = lambda: play(fields, weights, out, scratch)  # noqa: E731
    linear = lambda: play_linear(fields, weights, out)  # noqa: E731
    _seconds(hybrid)
    _seconds(linear)
    times = np.array([[_seconds(hybrid), _seconds(linear)] for _ in range(repeats)])
    times = np.median(times, axis=0) / (len(weights) * fields.inputs.shape[1])
    stored, dense = stored_bytes(fields)
    value = [*times, times[0] / times[1], stored / dense if dense else 0.0, float(np.max(space.error))]
    names = ["hybrid", "linear", "hybrid / linear", "memory", "error"]
    return Measures(np.array([value]), np.array(names), np.array(["s", "s", "1", "1", "m"]))


def _weights(count: int) -> np.ndarray:
    """Nine weights (9, N) strictly between the inputs: evenly spaced for two."""
    share = np.linspace(0.1, 0.9, 9)
    if count == 2:
        return np.stack([1.0 - share, share], axis=1)
    return np.random.default_rng(0).dirichlet(np.ones(count), 9)


def _seconds(call: Callable[[], None]) -> float:
    start = time.thread_time()
    call()
    return time.thread_time() - start


@njit(cache=True, nogil=True)
def play(fields: HybridFields, weights: np.ndarray, out: np.ndarray, scratch: np.ndarray) -> None:
    """Evaluate all poses at all weights (W, N) into out (V, 3)."""
    for k in range(len(weights)):
        for pose in range(fields.inputs.shape[1]):
            evaluate(fields, pose, weights[k], out, scratch)


@njit(cache=True, nogil=True)
def play_linear(fields: HybridFields, weights: np.ndarray, out: np.ndarray) -> None:
    """The same by linear blending."""
    for k in range(len(weights)):
        for pose in range(fields.inputs.shape[1]):
            linear_into(fields, pose, weights[k], out)
