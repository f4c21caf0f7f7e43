"""How long the search for transitions takes."""

from __future__ import annotations

import time
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.transitions import find_transitions
from reperform.nodes.product import Pairs
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.motion import Dissimilarity


@node(over="dataset", volatile=True)
def transition_time(
    similarity: Pairs[Dissimilarity],
    *,
    transitions: Annotated[int, Param("1", 1, 100, "kept per ordered pair of takes (N)")] = 4,
    shortest: Annotated[int, Param("frame", 1, 100, "least half length L")] = 1,
    longest: Annotated[int, Param("frame", 1, 100, "greatest half length L")] = 24,
    repeats: Annotated[int, Param("1", 1, 1000, "of which the median counts")] = 5,
) -> Measures:
    """Wall time of the search for (m, n, L) in each ordered pair of takes, entry `search` s: (pair,).

    Source: 000 section 4.2 (under 100 ms with N = 4).
    """
    matrices = [np.asarray(product.distance, np.float64) for product in similarity.values()]
    find_transitions(matrices[0], transitions, shortest, longest)
    values = [
        [_seconds(matrix, transitions, shortest, longest) for _ in range(repeats)] for matrix in matrices
    ]
    return Measures(np.median(values, axis=1)[:, None], np.array(["search"]), np.array(["s"]))


def _seconds(matrix: np.ndarray, transitions: int, shortest: int, longest: int) -> float:
    start = time.perf_counter()
    find_transitions(matrix, transitions, shortest, longest, spread=shortest)
    return time.perf_counter() - start
