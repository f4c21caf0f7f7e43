"""Costs of the best paths between all pairs of poses, as curves."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.product import Dataset
from reperform.nodes.products.essential import PathCosts, PoseGraph


@node(over="dataset", memory=2.0)
def path_costs(
    essential: Dataset[PoseGraph],
    baseline: Dataset[PoseGraph],
    *,
    samples: Annotated[int, Param("1", 2, 100000, "paths kept of each graph, evenly along the curve")] = 1000,
) -> PathCosts:
    """The cost of the best path between every ordered pair of poses, in the order of the baseline's.

    essential, baseline: graphs of the same databases in the same order, a panel each. Pairs that the baseline does not
    join are left out.

    Raises ValueError where the graphs do not go together.
    Source: Boukhayma and Boyer 2015, 3DV (002 fig 6).
    """
    ours, theirs = list(essential.values()), list(baseline.values())
    if [np.asarray(g.frames).tolist() for g in ours] != [np.asarray(g.frames).tolist() for g in theirs]:
        raise ValueError(
            "evaluate.path_costs: both lists must hold graphs of the same takes in the same order, got "
            f"{', '.join(essential)} and {', '.join(baseline)}"
        )
    curves = [
        _curve(np.asarray(a.distance), np.asarray(b.distance), samples)
        for a, b in zip(ours, theirs, strict=True)
    ]
    return PathCosts(
        np.array(list(essential)),
        np.array([float(graph.alpha) for graph in ours]),
        np.array(
            [int(np.isfinite(np.asarray(graph.distance)).sum() - len(graph.distance)) for graph in theirs],
            np.int32,
        ),
        np.stack(curves).astype(np.float32),
    )


def _curve(ours: np.ndarray, theirs: np.ndarray, samples: int) -> np.ndarray:
    """(samples, 3): the baseline's cost, that of the same pair of poses, and the sorted costs of ours."""
    kept = np.isfinite(theirs) & ~np.eye(len(theirs), dtype=bool)
    order = np.argsort(theirs[kept], kind="stable")
    chosen = np.linspace(0, max(len(order) - 1, 0), samples).round().astype(int)
    if not len(order):
        return np.full((samples, 3), np.nan)
    return np.stack(
        [theirs[kept][order][chosen], ours[kept][order][chosen], np.sort(ours[kept])[chosen]], axis=1
    )
