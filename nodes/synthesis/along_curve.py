"""Motion along a curve on the ground, with actions prescribed on stretches of it."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.curve_walk import (
    Curve,
    CurveWalk,
    curve_walk,
)
from reperform.nodes.kernels.depth_first_walk import depth_first_walk
from reperform.nodes.kernels.graph_moves import PlayedFrames, play_moves
from reperform.nodes.product import Dataset, Pairs
from reperform.nodes.products.essential import PoseGraph
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.products.pose_walk import PoseWalk
from reperform.nodes.synthesis.curve_problem import curve_problem
from reperform.nodes.synthesis.pose_graph_walk import graph_of, walk_product

_WHO = "synthesis.along_curve"


@node(over="dataset", memory=2.0)
def along_curve(
    graph: PoseGraph,
    similarity: Pairs[Dissimilarity],
    meshes: Dataset[MeshSequence],
    *,
    curve: Annotated[
        tuple[tuple[float, float], ...], Param("m", about="points (x, z) that the way goes through")
    ],
    actions: Annotated[
        tuple[str, ...],
        Param(about="what is played where, as FROM-TO TAKE, metres along the curve; TAKE may hold * and ?"),
    ] = (),
    start: Annotated[str, Param(about="the first pose, as TAKE:FRAME; empty: any")] = "",
    distance_weight: Annotated[
        float, Param("1/m", 0.0, 1e6, "cost of a frame one metre off the curve")
    ] = 0.2,
    search: Annotated[
        Literal["arc_length", "depth_first"], Param(about="the table over arc length, or the seed's")
    ] = ("arc_length"),
    beam: Annotated[
        int, Param("1", 1, 100_000, "walks followed per stretch of 5 cm, the most promising")
    ] = 1000,
    expansions: Annotated[int, Param("1", 1, 10**10, "moves that depth_first tries at most")] = 20_000_000,
) -> PoseWalk:
    """The motion of least cost whose body follows a curve, doing what is prescribed on stretches of it.

        cost = sum over moves of E + distance_weight sum over frames |body - curve(arc length walked so far)|

    on the ground, the body's centre the mean vertex; ends where the arc length walked is the curve's. The curve is the
    natural cubic spline through the points. On a stretch with an action every frame comes from a take of that name
    (of two blended ones the heavier counts). `bound` is under the cost of every walk: it leaves out the distances.

    Raises ValueError where points or actions cannot be read, no take has an action's name, the starting pose does not
    exist, or no walk gets to the end with what is allowed.

    Source: Boukhayma and Boyer 2015, 3DV (002 section 4, 3D behavioural path synthesis, eq 8). Departure: on the
    ground, since a body's height is its own; costs of moves count too; a table over arc length by default.
    """
    ready = graph_of(graph, similarity, meshes, _WHO)
    problem = curve_problem(ready, curve, actions, start, distance_weight, _WHO)
    starts = problem.starts
    walk: CurveWalk | None
    if search == "arc_length":
        walk = curve_walk(problem.trail, problem.rest, starts, beam)
    else:
        walk, _ = depth_first_walk(problem.trail, None, starts, expansions)
    if walk is None:
        raise ValueError(
            f"{_WHO}: no walk was found to the end of the {problem.curve.length:.2f} m: "
            f"raise {'beam' if search == 'arc_length' else 'expansions'}, or leave gaps between the stretches of actions"
        )
    played = play_moves(
        ready.moves, walk.chain, float(starts.yaw[walk.start]), tuple(starts.offset[walk.start].tolist())
    )
    played, wanted = _to_the_end(played, problem.curve)
    return walk_product(
        ready, played, walk.chain, cost=walk.cost, bound=problem.bound, expanded=walk.expanded, wanted=wanted
    )


def _to_the_end(played: PlayedFrames, curve: Curve) -> tuple[PlayedFrames, np.ndarray]:
    """The frames up to the curve's end, and where each was wanted, (F, 3) with no height."""
    ground = played.middle[:, [0, 2]]
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(ground, axis=0), axis=1))])
    count = min(int(np.searchsorted(arc, curve.length)) + 1, len(arc))
    at = curve.step * np.arange(len(curve.points))
    x, z = (np.interp(arc[:count], at, curve.points[:, k]) for k in range(2))
    return PlayedFrames(*(column[:count] for column in played)), np.column_stack(
        [x, np.full(count, np.nan), z]
    )
