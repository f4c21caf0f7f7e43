"""Exact shape-colour dissimilarity where it decides."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.transitions import find_transitions
from reperform.nodes.kernels.turned_transport import exact_distances
from reperform.nodes.product import Pair
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.products.shape_colour import ShapeColourHistograms
from reperform.nodes.similarity.shape_colour import ColourWeight, Turns, all_bins, equal_takes


@node(over="pair", memory=0.5)
def shape_colour_refined(
    similarity: Dissimilarity,
    histograms: Pair[ShapeColourHistograms],
    *,
    transitions: Annotated[int, Param("1", 1, 100, "cheapest transitions that are solved exactly")] = 8,
    half_length: Annotated[int, Param("frame", 1, 100, "of the window of a transition (L)")] = 4,
    apart: Annotated[int, Param("frame", 0, 1000, "within one take, the least |m - n|")] = 12,
    colour_weight: ColourWeight = 1.0,
    turns: Turns = 20,
) -> Dissimilarity:
    """The matrix of similarity.shape_colour with exact distances along its cheapest transitions: (frame_a, frame_b).

    Transitions (local minima of the windowed cost W_L) are solved with all filled bins, until the cheapest, as many
    as asked for, are all solved. All distances that are not are multiplied by the median ratio of exact distances to
    the matrix', so that both kinds can be compared. Ask for more than are needed: a transition that the matrix
    overrates by far may be missing at the end of them. colour_weight and turns must be those of the matrix.

    Raises ValueError where the matrix is not of these takes.

    Source: Seidl and Kriegel 1998, SIGMOD (optimal multi-step search); 000 section 4.2, eqs 2-5 (transitions).
    """
    a, b = histograms
    given = np.asarray(similarity.distance, np.float64)
    if given.shape != (len(a.share), len(b.share)):
        raise ValueError(
            f"similarity.shape_colour_refined: the matrix must be {len(a.share)} x {len(b.share)}, as the takes, got "
            f"{given.shape[0]} x {given.shape[1]}: wire the similarity.shape_colour of these histograms"
        )
    same = equal_takes(a, b)
    bins = all_bins(a, b, colour_weight, turns)
    exact, refined = np.full(given.shape, np.nan), given
    along = np.arange(1 - half_length, half_length)
    while True:
        found = find_transitions(
            refined, transitions, half_length, half_length, apart=apart if same else 0, spread=half_length
        )
        window = np.stack([found.m, found.n], axis=1)[:, None] + along[:, None]
        window = np.unique(window.reshape(-1, 2), axis=0)
        window = window[np.isnan(exact[tuple(window.T)])]
        if len(window) == 0:
            return Dissimilarity(refined.astype(np.float32))
        exact[tuple(window.T)] = exact_distances(*bins, turns, window)
        if same:
            exact[tuple(window[:, ::-1].T)] = exact[tuple(window.T)]
        counted = ~np.isnan(exact) & (given > 0)
        scale = np.median(exact[counted] / given[counted]) if counted.any() else 1.0
        refined = np.where(np.isnan(exact), scale * given, exact)
