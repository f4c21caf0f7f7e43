"""Corrections of linear blending at bisected weights, until what is left is small."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal, NamedTuple

import numpy as np
from numba import njit

from reperform.nodes.kernels.hybrid_blend import HybridFields, hat_values, linear_into
from reperform.nodes.kernels.mesh_blend import MeshBlender, PoseSet
from reperform.nodes.kernels.weight_bisection import WeightBisection

# Runs begin and end at multiples of this many coordinates: compiled loops then have no slow remainders.
_LANES = 32
# Errors up to this many epsilons are small enough: where nothing is longer than epsilon, nothing can be mended.
_SLACK = 1.1
# Rounding to codes may err by this many epsilons.
_ROUNDING = 0.1
# What a run costs besides its codes: first coordinate and where the codes start.
_RUN_BYTES = 8


Codes = Literal["auto", "int8", "int16"]


class Hybrid(NamedTuple):
    """Fields with what they promise."""

    fields: HybridFields
    # weights of every correction (K, N)
    weights: np.ndarray
    # per pose the largest distance to the non-linear blend over the weights that were tried, m
    error: np.ndarray


def nonlinear_blends(
    inputs: np.ndarray, faces: np.ndarray, rest: np.ndarray | None = None
) -> Callable[[np.ndarray], np.ndarray]:
    """The non-linear blend of all poses, (T, V, 3), as a function of weights (N,); inputs: (N, T, V, 3), m.

    rest: (V, 3), to which deformations are told; the first pose of the first input by default.
    """
    blender = MeshBlender.build(inputs[0, 0] if rest is None else rest, faces)
    sets: list[PoseSet] = []
    for pose in range(inputs.shape[1]):
        sets.append(blender.poses(list(inputs[:, pose]), sets[-1] if sets else None))
    return lambda weights: np.stack([blender.blend(poses, weights) for poses in sets])


def build_hybrid(
    inputs: np.ndarray,
    exact: Callable[[np.ndarray], np.ndarray],
    epsilon: float,
    levels: int,
    deepest: int,
    codes: Codes = "auto",
) -> Hybrid:
    """Correct linear blending towards `exact`.

    inputs: (N, T, V, 3) float32, N >= 2, m; exact: weights (N,) to (T, V, 3). A correction is stored where it
    is longer than epsilon (m); codes are int8 where that rounds by less than a tenth of epsilon, else int16
    (auto). levels: how often all weights are halved; 0: where and
    until the largest distance to `exact` is about epsilon (1.1 of it at most), not more than `deepest` times.
    """
    builder = _Builder(inputs, exact, epsilon, codes)
    builder.refine(levels or deepest, always=levels > 0)
    return builder.finished()


class _Builder:
    """Grows the bisection and the corrections."""

    def __init__(
        self, inputs: np.ndarray, exact: Callable[[np.ndarray], np.ndarray], epsilon: float, codes: Codes
    ) -> None:
        self.inputs = np.ascontiguousarray(inputs, np.float32)
        self.exact, self.epsilon = exact, epsilon
        self.known: dict[bytes, np.ndarray] = {}
        if codes == "auto":
            middle = np.full(len(inputs), 1.0 / len(inputs))
            left = np.abs(self._exact(middle) - np.einsum("n,ntvk->tvk", middle, self.inputs)).max()
            codes = "int8" if left / np.iinfo(np.int8).max / 2.0 <= _ROUNDING * epsilon else "int16"
        self.dtype = np.dtype(codes)
        self.tree = WeightBisection(len(inputs))
        self.stored: list[np.ndarray] = []
        self.parts: list[_Coded] = []

    def refine(self, levels: int, always: bool) -> None:
        """Cut what needs it, level by level, until nothing does."""
        limit = levels * (len(self.inputs) - 1)
        sound: set[int] = set()
        while True:
            waiting = [s for s in self.tree.leaves if self.tree.depth[s] < limit and s not in sound]
            if not waiting:
                return
            simplex = min(waiting, key=lambda s: (self.tree.depth[s], s))
            if always or self._error(simplex) > _SLACK * self.epsilon:
                self._cut(simplex)
                sound.clear()
            else:
                sound.add(simplex)

    def finished(self) -> Hybrid:
        """The fields, and what they leave at the weights that were or can be tried."""
        n = len(self.inputs)
        error = np.zeros(self.inputs.shape[1])
        for simplex in self.tree.leaves:
            for weights in self.tree.probes(simplex):
                error = np.maximum(error, self._gap(weights))
        points = np.array(self.tree.points[n:]).reshape(-1, n)
        return Hybrid(_packed(self.inputs, self.tree, self.parts, self.dtype), points, error)

    def _cut(self, simplex: int) -> None:
        while self.tree.split[simplex] < 0:
            conflicts = self.tree.conflicts(simplex)
            if conflicts:
                self._cut(conflicts[0])
                continue
            weights = self.tree.middle(simplex)
            left = self._exact(weights) - self._approximate(weights)
            self.tree.cut(simplex)
            coded = _code(left, self.epsilon, self.dtype)
            self.parts.append(coded)
            self.stored.append(_decode(coded, left.shape))

    def _error(self, simplex: int) -> float:
        return max(float(self._gap(weights).max()) for weights in self.tree.probes(simplex))

    def _gap(self, weights: np.ndarray) -> np.ndarray:
        left = self._exact(weights) - self._approximate(weights)
        return np.asarray(np.sqrt(np.einsum("tvk,tvk->tv", left, left).max(axis=1)))

    def _exact(self, weights: np.ndarray) -> np.ndarray:
        key = weights.tobytes()
        if key not in self.known:
            self.known[key] = self.exact(weights)
        return self.known[key]

    def _approximate(self, weights: np.ndarray) -> np.ndarray:
        poses, count = self.inputs.shape[1:3]
        empty = np.zeros(0)
        fields = HybridFields(
            self.inputs.reshape(len(self.inputs), poses, -1), np.array(self.tree.split, np.int32),
            np.array(self.tree.child, np.int32), np.zeros(1, np.int64), np.zeros(0, np.int32),
            np.zeros(1, np.int32), np.zeros(0, self.dtype), empty.reshape(0, 0).astype(np.float32),
        )  # fmt: skip
        node, value = np.empty(64, np.int64), np.empty(64)
        found = hat_values(fields, weights, node, value, np.empty(len(weights)))
        out = np.empty((poses, count, 3), np.float32)
        for pose in range(poses):
            linear_into(fields, pose, weights, out[pose])
        for k in range(found):
            out += np.float32(value[k]) * self.stored[node[k]]
        return out


class _Coded(NamedTuple):
    """One correction of all poses: runs (first coordinate, length) of each pose, codes, and metres per code."""

    runs: list[np.ndarray]
    code: list[np.ndarray]
    step: np.ndarray


def _code(field: np.ndarray, epsilon: float, dtype: np.dtype) -> _Coded:
    """Keep of a field (T, V, 3) what is longer than epsilon, with small gaps, in whole steps."""
    runs, codes, steps = [], [], np.zeros(len(field), np.float32)
    largest = np.iinfo(dtype).max
    for pose, part in enumerate(field):
        found = _runs(np.einsum("vk,vk->v", part, part) > epsilon * epsilon)
        flat = part.ravel()
        kept = np.concatenate([flat[:0], *(flat[a : a + n] for a, n in found)])
        steps[pose] = np.abs(kept).max(initial=0.0) / largest
        code = np.rint(kept / steps[pose]) if steps[pose] > 0.0 else np.zeros_like(kept)
        runs.append(found)
        codes.append(np.clip(code, -largest, largest).astype(dtype))
    return _Coded(runs, codes, steps)


@njit(cache=True, nogil=True)
def _runs(chosen: np.ndarray) -> np.ndarray:
    """Runs (first, length) of coordinates that hold all chosen vertices."""
    out = np.empty((len(chosen) + 1, 2), np.int32)
    count, start, end = 0, 0, -1
    for v in range(len(chosen)):
        if not chosen[v]:
            continue
        begin = 3 * v // _LANES * _LANES
        if begin > end:
            start = begin
            count += 1
        end = max(end, (3 * v + 2 + _LANES) // _LANES * _LANES)
        out[count - 1, 0], out[count - 1, 1] = start, min(end, 3 * len(chosen)) - start
    return out[:count]


def _decode(coded: _Coded, shape: tuple[int, ...]) -> np.ndarray:
    field = np.zeros((shape[0], shape[1] * shape[2]), np.float32)
    for pose, (runs, code) in enumerate(zip(coded.runs, coded.code, strict=True)):
        values = coded.step[pose] * code.astype(np.float32)
        at = 0
        for first, length in runs.tolist():
            field[pose, first : first + length] = values[at : at + length]
            at += length
    return field.reshape(shape)


def _packed(
    inputs: np.ndarray, tree: WeightBisection, parts: Sequence[_Coded], dtype: np.dtype
) -> HybridFields:
    poses = inputs.shape[1]
    runs = [rows for coded in parts for rows in coded.runs]
    table = np.concatenate(runs) if runs else np.zeros((0, 2), np.int32)
    codes = [code for coded in parts for code in coded.code]
    return HybridFields(
        inputs=inputs.reshape(len(inputs), poses, -1),
        split=np.array(tree.split, np.int32),
        child=np.array(tree.child, np.int32),
        start=np.concatenate([[0], np.cumsum([len(rows) for rows in runs])]).astype(np.int64),
        first=np.ascontiguousarray(table[:, 0]),
        begin=np.concatenate([[0], np.cumsum(table[:, 1])]).astype(np.int32),
        code=np.concatenate(codes) if codes else np.zeros(0, dtype),
        step=np.array([coded.step for coded in parts], np.float32).reshape(-1, poses),
    )


def stored_bytes(fields: HybridFields) -> tuple[int, int]:
    """Bytes of the corrections as they are stored, and of the same corrections as dense float32."""
    sparse = fields.code.nbytes + _RUN_BYTES * len(fields.first) + fields.step.nbytes + fields.start.nbytes
    return sparse, 4 * fields.step.size * fields.inputs.shape[2]
