"""The best motion from one pose to another."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.graph_moves import play_moves
from reperform.nodes.kernels.shortest_moves import shortest_moves
from reperform.nodes.product import Dataset, Pairs
from reperform.nodes.products.essential import PoseGraph
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.products.pose_walk import PoseWalk
from reperform.nodes.synthesis.pose_graph_walk import graph_of, walk_product

_WHO = "synthesis.pose_to_pose"


@node(over="dataset", memory=1.0)
def pose_to_pose(
    graph: PoseGraph,
    similarity: Pairs[Dissimilarity],
    meshes: Dataset[MeshSequence],
    *,
    start: Annotated[str, Param(about="the pose to leave, as TAKE:FRAME")],
    end: Annotated[str, Param(about="the pose to reach, as TAKE:FRAME")],
    via: Annotated[tuple[str, ...], Param(about="poses to pass in between, in order, as TAKE:FRAME")] = (),
) -> PoseWalk:
    """The motion of least cost from one captured pose to another, by the shortest path through the pose graph.

        cost = sum over moves of E = D + alpha L   (deformation of blended frames, and frames played)

    In an essential graph there is a motion between any two poses, and none in the complete graph of all transitions is
    cheaper. Blended transitions follow their warps, smoothed, and are laid on each other anew in every frame.

    Raises ValueError where a pose does not exist or the graph has no way there.

    Source: Boukhayma and Boyer 2015, 3DV (002 eq 7, section 5).
    """
    ready = graph_of(graph, similarity, meshes, _WHO)
    names = (start, *via, end)
    poses = [ready.pose(text, _WHO) for text in names]
    chain: list[int] = []
    shown = [0]
    for k in range(1, len(poses)):
        part = shortest_moves(ready.moves, poses[k - 1], poses[k])
        if part is None:
            raise ValueError(
                f"{_WHO}: the graph has no way from {names[k - 1]} to {names[k]}: use motion_graph.essential"
            )
        chain += part
        shown.append(shown[-1] + int(ready.moves.steps[part].sum()))
    if not chain:
        raise ValueError(f"{_WHO}: start and end are one pose, {start}: name two poses, or one in between")
    cost = float(ready.moves.cost[chain].sum())
    return walk_product(
        ready, play_moves(ready.moves, chain), chain, cost=cost, bound=cost, expanded=len(ready.moves.source),
        shown=shown, asked=np.full(len(shown), np.nan).tolist(),
    )  # fmt: skip
