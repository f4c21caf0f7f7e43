"""Whether a dissimilarity orders pairs of frames as another does."""

from __future__ import annotations

import numpy as np
from scipy.stats import spearmanr

from reperform.nodes.declaration import node
from reperform.nodes.product import Pairs
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.motion import Dissimilarity


@node(over="dataset", memory=1.0)
def rank_correlation(similarity: Pairs[Dissimilarity], reference: Pairs[Dissimilarity]) -> Measures:
    """Spearman's rank correlation of two dissimilarities, of all pairs of takes together and pair by pair.

    similarity, reference: matrices of the same pairs of takes; a frame against itself is left out. Entries `all`
    (pooled over all cells of all pairs), `mean` and `least` (of the correlations of single pairs).

    Raises ValueError where the pairs or their shapes differ.
    Source: definition (Spearman 1904); 002 section 3.1 compares metrics so.
    """
    if set(similarity) != set(reference):
        other = sorted("-".join(pair) for pair in set(similarity) ^ set(reference))
        raise ValueError(
            f"evaluate.rank_correlation: both need the same pairs of takes, one lacks {other[0]}"
        )
    cells = [
        _cells(np.asarray(ours.distance), np.asarray(reference[pair].distance), pair)
        for pair, ours in similarity.items()
    ]
    single = [_spearman(ours, theirs) for ours, theirs in cells]
    pooled = _spearman(*(np.concatenate(column) for column in zip(*cells, strict=True)))
    values = [pooled, float(np.mean(single)), float(np.min(single))]
    return Measures(np.array([values]), np.array(["all", "mean", "least"]), np.array(["1", "1", "1"]))


def _cells(ours: np.ndarray, theirs: np.ndarray, pair: tuple[str, str]) -> tuple[np.ndarray, np.ndarray]:
    if ours.shape != theirs.shape:
        raise ValueError(
            f"evaluate.rank_correlation: {pair[0]}, {pair[1]}: both matrices must have one shape, got "
            f"{ours.shape} and {theirs.shape}: make both of the same takes"
        )
    kept = ~np.eye(len(ours), dtype=bool) if pair[0] == pair[1] else np.ones(ours.shape, bool)
    return ours[kept], theirs[kept]


def _spearman(ours: np.ndarray, theirs: np.ndarray) -> float:
    """nan where one of them is constant."""
    if len(ours) < 2 or np.ptp(ours) == 0 or np.ptp(theirs) == 0:
        return float("nan")
    return float(spearmanr(ours, theirs).statistic)
