"""Measures of dissimilarity side by side."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.transitions import find_transitions
from reperform.nodes.product import Pairs
from reperform.nodes.products.measure_comparison import MeasureComparison
from reperform.nodes.products.motion import Dissimilarity

NAMES = ("shape and colour", "shape", "vertices", "skeleton", "deformation gradient")


@node(over="dataset", memory=1.0)
def compare(
    shape_colour: Pairs[Dissimilarity],
    shape: Pairs[Dissimilarity],
    vertex: Pairs[Dissimilarity],
    skeleton: Pairs[Dissimilarity],
    deformation_gradient: Pairs[Dissimilarity] | None = None,
    *,
    transitions: Annotated[int, Param("1", 0, 100, "kept per ordered pair of takes (N)")] = 4,
    half_length: Annotated[int, Param("frame", 1, 100, "of the window over which costs are taken (L)")] = 4,
    apart: Annotated[int, Param("frame", 0, 1000, "least time between both ends within one take")] = 10,
) -> MeasureComparison:
    """The matrices of all takes under four or five measures, and where each would pass from take to take.

    Transitions are the N local minima of least cost sum_k (L - |k|) c(m + k, n + k) / L^2, |k| < L, that differ by
    at least L in m or n.

    Raises ValueError where the measures differ in takes or frames.

    Source: 000 section 4.2, fig 4 (L = 4, N = 4).
    """
    given = (shape_colour, shape, vertex, skeleton, deformation_gradient)
    products = [product for product in given if product is not None]
    takes = list(dict.fromkeys(a for a, _ in shape_colour))
    frames = [int(shape_colour[take, take].distance.shape[0]) for take in takes]
    whole = np.stack([_whole(product, takes, frames) for product in products])
    rows: list[tuple[int, int, int, int, int, float]] = []
    for k, product in enumerate(products):
        for (a, b), matrix in product.items():
            distance = np.asarray(matrix.distance, np.float64)
            best = find_transitions(
                distance,
                transitions,
                half_length,
                half_length,
                apart=apart if a == b else 0,
                spread=half_length,
            )
            ends = (takes.index(a), takes.index(b))
            rows += [
                (k, *ends, int(m), int(n), float(c))
                for m, n, c in zip(best.m, best.n, best.cost, strict=True)
            ]
    table = np.array(rows, np.float64).reshape(-1, 6)
    measure, source, target, m, n = table[:, :5].T.astype(np.int32)
    return MeasureComparison(
        np.array(NAMES[: len(products)]), np.array(takes), np.array(frames, np.int32), whole.astype(np.float32),
        measure, source, target, m, n, table[:, 5].copy(), np.asarray(half_length, np.int32),
    )  # fmt: skip


def _whole(product: Pairs[Dissimilarity], takes: Sequence[str], frames: Sequence[int]) -> np.ndarray:
    """All pairs of takes in one matrix."""
    for a, rows in zip(takes, frames, strict=True):
        for b, columns in zip(takes, frames, strict=True):
            got = tuple(product[a, b].distance.shape) if (a, b) in product else None
            if got != (rows, columns):
                raise ValueError(
                    f"similarity.compare: every measure must compare {a} with {b}, {rows} x {columns} frames, got "
                    f"{got}: wire matrices of the same takes"
                )
    return np.block([[np.asarray(product[a, b].distance) for b in takes] for a in takes])
