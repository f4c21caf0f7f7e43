"""Which takes belong in one parametric space."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.time_warp import warped_distance
from reperform.nodes.product import Pairs
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.products.parametric import SpaceSuggestion

_WHO = "motion_graph.suggest_spaces"


@node(over="dataset")
def suggest_spaces(
    similarity: Pairs[Dissimilarity],
    *,
    cut: Annotated[
        float,
        Param("1", 0.0, None, "distance up to which takes are joined; 0: where clusters are clearest"),
    ] = 0.0,
) -> SpaceSuggestion:
    """Takes of like motion, found by warping every take onto every other: those that can be blended with each other.

    similarity: (frames of a, frames of b) for every ordered pair of takes, as of similarity.vertex_velocity. The
    distance of two takes is the mean dissimilarity along the best warp at half to twice the pace, starting anywhere
    and going round at the end (both ways, averaged), so phase and length do not matter. Takes are joined by average
    linkage; without `cut` the tree is cut where the mean silhouette is greatest.

    Raises ValueError where takes are fewer than two or a pair is missing.

    Source: Kovar and Gleicher 2004, SIGGRAPH (like motions by time warping); Rousseeuw 1987, J. Comput. Appl. Math. 20;
    004 section 4.5.2 names it as open.
    """
    takes = list(dict.fromkeys(take for pair in similarity for take in pair))
    if len(takes) < 2:
        raise ValueError(f"{_WHO}: two takes or more needed, got {', '.join(takes) or 'none'}")
    missing = [f"{a}, {b}" for a in takes for b in takes if a != b and (a, b) not in similarity]
    if missing:
        raise ValueError(f"{_WHO}: every ordered pair of takes needed, missing {'; '.join(missing)}")
    distance = np.zeros((len(takes), len(takes)))
    for i, a in enumerate(takes):
        for j, b in enumerate(takes[:i]):
            distance[i, j] = distance[j, i] = 0.5 * (_warped(similarity[a, b]) + _warped(similarity[b, a]))
    joins = linkage(squareform(distance, checks=False), method="average")
    height = cut if cut > 0 else _clearest(joins, distance)
    label = fcluster(joins, height, criterion="distance")
    return SpaceSuggestion(
        np.array(takes), _by_appearance(label), distance.astype(np.float32), joins, np.array(height)
    )


def _warped(product: Dissimilarity) -> float:
    return float(warped_distance(np.array(product.distance, np.float64, order="C")))


def _clearest(joins: np.ndarray, distance: np.ndarray) -> float:
    """The height, half-way between two joins, at which clusters have the greatest mean silhouette."""
    heights = joins[:, 2]
    cuts = [2.0 * float(heights[-1])] if len(heights) == 1 else (0.5 * (heights[1:] + heights[:-1])).tolist()
    scores = [_silhouette(distance, fcluster(joins, cut, criterion="distance")) for cut in cuts]
    return float(cuts[int(np.argmax(scores))])


def _silhouette(distance: np.ndarray, label: np.ndarray) -> float:
    """Mean over takes of (b - a) / max(a, b): mean distance within its cluster a, to the nearest other b; 0 alone."""
    scores = []
    for k, own in enumerate(label.tolist()):
        mates = (label == own) & (np.arange(len(label)) != k)
        others = [distance[k, label == other].mean() for other in set(label.tolist()) - {own}]
        if not mates.any() or not others:
            scores.append(0.0)
            continue
        within, beyond = distance[k, mates].mean(), min(others)
        scores.append((beyond - within) / max(within, beyond, 1e-30))
    return float(np.mean(scores))


def _by_appearance(label: np.ndarray) -> np.ndarray:
    """Labels counted from 0 in the order in which they first appear."""
    order = {value: k for k, value in enumerate(dict.fromkeys(label.tolist()))}
    return np.array([order[value] for value in label.tolist()], np.int32)
