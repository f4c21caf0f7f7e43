"""Corrections of all cells of a space as one product, and taken apart again."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reperform.nodes.blend.space_fields import CODES
from reperform.nodes.kernels.hybrid_blend import HybridFields
from reperform.nodes.kernels.hybrid_build import Hybrid
from reperform.nodes.products.parametric import ParametricSpace
from reperform.nodes.products.space_corrections import SpaceCorrections


def packed_cells(space: ParametricSpace, built: Sequence[Hybrid], epsilon: float) -> SpaceCorrections:
    """The product of what was built for every cell of a space."""
    fields = [one.fields for one in built]
    codes = [one.code.view(np.uint8) for one in fields]
    sizes = [(len(f.split), len(f.step), len(f.first), len(c)) for f, c in zip(fields, codes, strict=True)]

    def joined(name: str) -> np.ndarray:
        return np.concatenate([getattr(one, name) for one in fields])

    return SpaceCorrections(
        takes=np.asarray(space.takes),
        cells=np.asarray(space.cells),
        poses=np.asarray(space.vertices.shape[1], np.int32),
        vertices=np.asarray(space.vertices.shape[2], np.int32),
        epsilon=np.asarray(epsilon, np.float64),
        error=np.stack([one.error for one in built]),
        bits=np.array([8 * one.code.itemsize for one in fields], np.int32),
        counts=np.array(sizes, np.int32),
        split=joined("split"),
        child=joined("child"),
        start=joined("start"),
        first=joined("first"),
        begin=joined("begin"),
        code=np.concatenate(codes),
        step=joined("step"),
    )


def cell_fields(corrections: SpaceCorrections) -> tuple[HybridFields, ...]:
    """Plain arrays for kernels.hybrid_blend.correct_between, one per cell; their inputs hold no vertices."""
    corners, poses = corrections.cells.shape[1], int(corrections.poses)
    split, child, start, first, begin, code, step = map(np.ascontiguousarray, corrections[-7:])
    bits, out = np.asarray(corrections.bits).tolist(), []
    at = np.zeros(6, np.int64)
    for width, (simplices, nodes, runs, size) in zip(
        bits, np.asarray(corrections.counts).tolist(), strict=True
    ):
        end = at + [simplices, nodes * poses + 1, runs, runs + 1, size, nodes]
        s, o, r, b, c, n = (slice(i, j) for i, j in zip(at.tolist(), end.tolist(), strict=True))
        own = split[s], child[s], start[o], first[r], begin[b], code[c].view(CODES[width]), step[n]
        out.append(HybridFields(np.zeros((corners, poses, 0), np.float32), *own))
        at = end
    return tuple(out)
