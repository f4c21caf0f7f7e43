"""The essential graph against the motion graph and the complete digraph, over all pairs of poses."""

from __future__ import annotations

import numpy as np
from scipy.sparse.csgraph import floyd_warshall

from reperform.nodes.declaration import node
from reperform.nodes.motion_graph.pose_edges import complete_digraph
from reperform.nodes.product import Pairs
from reperform.nodes.products.essential import PoseGraph, PoseTransitions
from reperform.nodes.products.measures import Measures

# relative difference of two sums of the same costs in another order
_ROUNDING = 1e-9


@node(over="dataset", memory=2.0)
def pose_paths(essential: PoseGraph, baseline: PoseGraph, transitions: Pairs[PoseTransitions]) -> Measures:
    """How the costs of the best paths between all ordered pairs of different poses compare.

    Entries: `at or below` (share of pairs whose path in `essential` costs no more than in `baseline`, unreachable
    there counting as dearer), `equal` (share whose cost is that of the complete digraph, by an independent
    Floyd-Warshall over all transitions), `saving` (mean over pairs that both join of 1 - cost / baseline's cost),
    `kept` (edges of `essential` over those of the complete digraph), `baseline kept`, `unreachable` (share of pairs
    that the baseline does not join), `poses`.

    Raises ValueError where the graphs are not of the same poses.
    Source: Boukhayma and Boyer 2015, 3DV (002 fig 6).
    """
    complete = complete_digraph(transitions, "evaluate.pose_paths").cost
    count = len(complete)
    ours, theirs = np.asarray(essential.distance), np.asarray(baseline.distance)
    if ours.shape != complete.shape or theirs.shape != complete.shape:
        raise ValueError(
            f"evaluate.pose_paths: all three must have the same poses, got {len(ours)}, {len(theirs)} and {count}: "
            f"make the graphs of these transitions"
        )
    apart = ~np.eye(count, dtype=bool)
    least = floyd_warshall(np.where(apart, complete, 0.0))[apart]
    ours, theirs = ours[apart], theirs[apart]
    joined = np.isfinite(theirs)
    values = {
        "at or below": (ours <= theirs * (1 + _ROUNDING)).mean(),
        "equal": (np.abs(ours - least) <= _ROUNDING * least).mean(),
        "saving": (1 - ours[joined] / theirs[joined]).mean() if joined.any() else np.nan,
        "kept": len(np.asarray(essential.source)) / apart.sum(),
        "baseline kept": len(np.asarray(baseline.source)) / apart.sum(),
        "unreachable": 1 - joined.mean(),
        "poses": float(count),
    }
    return Measures(np.array([list(values.values())]), np.array(list(values)), np.array(["1"] * len(values)))
