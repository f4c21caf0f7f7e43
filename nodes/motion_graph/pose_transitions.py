"""The best transition from every frame of one take to every frame of another."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.warped_transitions import best_transitions
from reperform.nodes.product import Pair
from reperform.nodes.products.essential import PoseTransitions
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity

_WHO = "motion_graph.pose_transitions"


@node(over="pair", memory=1.0)
def pose_transitions(
    similarity: Dissimilarity,
    meshes: Pair[MeshSequence],
    *,
    alpha: Annotated[float, Param("1/frame", 1e-6, 100.0, "what a frame of duration costs")] = 0.01,
    shortest: Annotated[float, Param("s", 0.02, 4.0, "least length of either window")] = 1 / 3,
    longest: Annotated[float, Param("s", 0.02, 10.0, "greatest length of either window")] = 2.0,
) -> PoseTransitions:
    """For every frame i of one take and j of the other, the transition from i to j that looks most real.

        E(i, j) = min over windows and warps of D + alpha L,   D = sum over the path of d,  L its steps

    similarity d: (frames of a, frames of b); meshes: the same two takes, for their frame rate. The path leads from
    (i, j - lj + 1) to (i + li - 1, j); both windows li, lj are from `shortest` to `longest`; it is continuous,
    never goes back and stays in one take for three steps at most. Windows are clipped at the ends of the takes;
    where that leaves less than `shortest`, the end frame is held, so that every frame has a transition to every
    other and none is a cut.

    Raises ValueError where the frame rates differ, the matrix does not fit the takes, holds negative or unknown
    dissimilarities, or longest is below shortest.

    Source: Boukhayma and Boyer 2015, 3DV (002 eqs 4-5, fig 2); Wang and Bodenheimer 2008 for the bounds.
    Departure: windows and warp minimise E as a whole, not D alone; end frames are held.
    """
    frames = tuple(len(take.vertices) for take in meshes)
    distance, rates = np.asarray(similarity.distance), [float(np.asarray(take.fps)) for take in meshes]
    if not np.isclose(rates[0], rates[1], rtol=1e-4):
        raise ValueError(
            f"{_WHO}: both takes must have one frame rate, got {rates[0]:g} and {rates[1]:g} Hz: resample one"
        )
    if distance.shape != frames:
        raise ValueError(
            f"{_WHO}: the matrix must be {frames}, one row and column per frame, got {distance.shape}: "
            f"wire the similarity of these meshes"
        )
    if not (np.isfinite(distance).all() and (distance >= 0).all()):
        raise ValueError(f"{_WHO}: dissimilarities must be finite and not negative")
    least, most = max(1, round(shortest * rates[0])), round(longest * rates[0])
    if most < least:
        raise ValueError(f"{_WHO}: longest ({longest:g} s) must not be below shortest ({shortest:g} s)")
    best = best_transitions(distance, alpha, least, most)
    return PoseTransitions(*best, np.array(alpha, np.float64), np.asarray(meshes[0].fps, np.float32))
