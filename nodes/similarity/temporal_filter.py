"""A dissimilarity averaged in time."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.temporal_filter import filter_adaptively, filter_diagonals
from reperform.nodes.products.motion import Dissimilarity


@node(over="pair", memory=0.5)
def temporal_filter(
    similarity: Dissimilarity,
    *,
    kind: Annotated[
        Literal["plain", "adaptive"],
        Param(about="one window everywhere, or at each pair of frames the one of least mean"),
    ] = "adaptive",
    shortest: Annotated[int, Param("frame", 1, 100, "least half length L of the adaptive window")] = 4,
    longest: Annotated[
        int, Param("frame", 1, 100, "greatest half length L; of the plain window, the half length")
    ] = 24,
) -> Dissimilarity:
    """The mean dissimilarity of the motions around every two frames, not of two poses alone: (frame_a, frame_b).

        plain:     S(a, b) = mean over |k| <= longest of D(a + k, b + k)
        adaptive:  S(a, b) = min over L = shortest .. longest of sum_k w_k D(a + k, b + k) / sum_k w_k,
                   w_k = L - |k|, |k| < L

    over the k with a + k and b + k inside. So motions that pass through one pose in different directions are told
    apart; the adaptive window is as long as the two motions go together.

    Raises ValueError where longest is below shortest.

    Source: Huang, Hilton and Starck 2010, IJCV 89 (plain); 000 section 4.2, eqs 2-5 (adaptive).
    Departure: sums are divided by their weights, else the shortest window always wins.
    """
    if kind == "adaptive" and longest < shortest:
        raise ValueError(
            f"similarity.temporal_filter: longest ({longest} frames) must not be below shortest ({shortest})"
        )
    matrix = np.ascontiguousarray(similarity.distance, np.float64)
    if kind == "plain":
        return Dissimilarity(filter_diagonals(matrix, longest).astype(np.float32))
    return Dissimilarity(filter_adaptively(matrix, shortest, longest)[0].astype(np.float32))
