"""How alike two takes are where one passes into the other."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.overlap_distance import overlap_distance
from reperform.nodes.product import Dataset
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph
from reperform.nodes.synthesis.graph_walk import passages_of


@node(over="dataset", memory=1.0)
def smoothness(
    graph: MotionGraph,
    meshes: Dataset[MeshSequence],
    *,
    samples: Annotated[int, Param("1", 1, 100, "frames of each transition that are measured, at most")] = 9,
) -> Measures:
    """Weighted mean Hausdorff distance of the overlapping frames, one row per transition of the graph, m.

    Entry `smoothness`: sum_k a'(k) H(source at m + k, placed target at n + k) / sum_k a'(k), a'(k) falling linearly
    from the middle of the transition to its ends.

    Raises ValueError where the graph was made of other takes.
    Source: Huang, Tejera, Collomosse and Hilton 2015, ACM TOG (000 section 6.1, table III).
    """
    missing = [take for take in map(str, np.asarray(graph.takes)) if take not in meshes]
    if missing:
        raise ValueError(
            f"evaluate.smoothness: the graph has take {missing[0]!r}, the meshes have {', '.join(meshes)}: "
            f"wire the meshes that the graph was made of"
        )
    takes = [np.asarray(meshes[take].vertices) for take in map(str, np.asarray(graph.takes))]
    values = [overlap_distance(passage, takes, samples) for passage in passages_of(graph)]
    return Measures(np.array(values).reshape(-1, 1), np.array(["smoothness"]), np.array(["m"]))
