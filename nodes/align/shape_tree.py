"""The shape similarity tree: the way by which every frame can be aligned to one root frame."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.spanning_tree import minimum_spanning_tree, path_cost_sums, rehang
from reperform.nodes.product import Pairs
from reperform.nodes.products.motion import Dissimilarity, ShapeTree


@node(over="dataset", memory=1.0)
def shape_tree(
    similarity: Pairs[Dissimilarity],
    *,
    neighbour_factor: Annotated[
        float, Param("1", 0.0, 1.0, "the dissimilarity of consecutive frames of one take counts this much")
    ] = 0.7,
) -> ShapeTree:
    """The spanning tree over all frames of all takes along which shapes change least; one row per frame.

    T = argmin over spanning trees of the sum of d(i, j) over its edges (Prim's algorithm on the whole
    matrix). The root is the frame with the least sum of path lengths to all others, ties to the earlier
    frame; `order` visits parents before children. Consecutive frames of a take are favoured by
    `neighbour_factor` (1 for none), since motion can be predicted along them and no turn has to be
    searched; `distance` is as given, not favoured.

    Raises ValueError where a pair of takes is missing or the matrices do not fit each other.

    Source: 004 section 2.2.2, eq 2.1; Budd, Huang, Klaudiny and Hilton, IJCV 2013.
    Departure: no pruning of the graph at the minimum of the row maxima of similarity: it can cut the graph in
    pieces, and the dense algorithm needs no help. The root is chosen, since depth costs accuracy.
    """
    takes = list(dict.fromkeys(a for a, _ in similarity))
    matrix = _whole_matrix(similarity, takes)
    frames = [similarity[take, take].distance.shape[0] for take in takes]
    take = np.repeat(np.arange(len(takes), dtype=np.int32), frames)
    frame_index = np.concatenate([np.arange(count, dtype=np.int32) for count in frames])
    favoured = matrix.copy()
    following = np.flatnonzero(take[1:] == take[:-1])
    favoured[following, following + 1] *= neighbour_factor
    favoured[following + 1, following] *= neighbour_factor

    parent, order = minimum_spanning_tree(favoured)
    sums = path_cost_sums(parent, order, favoured[np.arange(len(parent)), parent])
    parent, order = rehang(parent, int(np.argmin(sums)))
    distance = matrix[np.arange(len(parent)), parent]
    distance[order[0]] = 0
    return ShapeTree(np.array(takes), take, frame_index, parent, distance.astype(np.float32), order)


def _whole_matrix(similarity: Pairs[Dissimilarity], takes: list[str]) -> np.ndarray:
    missing = [(a, b) for a in takes for b in takes if (a, b) not in similarity]
    if missing or not takes:
        raise ValueError(
            f"shape_tree: every ordered pair of takes must be compared, missing {missing[:3] or 'all'}: "
            "wire a node that is mapped over pairs, such as similarity.shape"
        )
    blocks = [[np.asarray(similarity[a, b].distance, np.float64) for b in takes] for a in takes]
    counts = [row[k].shape[0] for k, row in enumerate(blocks)]
    for i, a in enumerate(takes):
        for j, b in enumerate(takes):
            if blocks[i][j].shape != (counts[i], counts[j]):
                raise ValueError(
                    f"shape_tree: takes {a} and {b} have {counts[i]} and {counts[j]} frames, but their "
                    f"matrix is {blocks[i][j].shape}: compare them again"
                )
    matrix = np.block(blocks)
    if not np.isfinite(matrix).all():
        raise ValueError("shape_tree: every dissimilarity must be finite: some are nan or infinite")
    return (matrix + matrix.T) / 2
