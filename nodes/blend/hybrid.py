"""A space of blends that is evaluated in real time."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.blend.corresponding_poses import chosen_takes, corresponding_poses
from reperform.nodes.blend.pair_frames import Pace
from reperform.nodes.blend.space_fields import blend_space
from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.hybrid_build import Codes, build_hybrid, nonlinear_blends
from reperform.nodes.product import Dataset
from reperform.nodes.products.blend_space import BlendSpace
from reperform.nodes.products.mesh import MeshSequence


@node(over="dataset", memory=2.0)
def hybrid(
    meshes: Dataset[MeshSequence],
    *,
    takes: Annotated[tuple[str, ...], Param("", about="the takes to blend, in order; none: all")] = (),
    epsilon: Annotated[float, Param("m", 0.0, 1.0, "error that needs no correction")] = 0.005,
    levels: Annotated[
        int,
        Param("1", 0, 6, "how often weights are halved everywhere; 0: where and until the error is small"),
    ] = 0,
    deepest: Annotated[int, Param("1", 1, 6, "how often weights are halved at most")] = 4,
    codes: Annotated[
        Codes,
        Param(about="what corrections are rounded to; auto: int8 where that errs by epsilon / 10 at most"),
    ] = "auto",
    pace: Annotated[Pace, Param(about="how frames of the takes correspond")] = "stretched",
    place: Annotated[bool, Param(about="lay the other takes on the first on the ground")] = True,
) -> BlendSpace:
    """All blends of N takes, pose by corresponding pose: linear ones, corrected towards the non-linear blend.

        x(w) = sum_i w_i x_i + sum_k h_k(w) d_k,   d_k = x_nonlinear(w_k) - what comes before k, at w_k

    The simplex of weights is halved again and again at new weights w_k; h_k is 1 at w_k, 0 at all earlier ones
    and linear between. A correction d_k is stored on the vertices where it is longer than epsilon, in int8 or
    int16 codes. With levels = L all weights are halved L times (for two takes R = 2^L - 1 corrections); with 0,
    until the error is epsilon (at most 1.1 of it) at the quarters and middles of every part. `error` says per pose what is
    left there. At the takes themselves (a weight of 1) the blend is exact.

    Raises ValueError where takes differ in topology or frame rate, one is not there, or there are fewer than
    two.

    Source: Casas, Tejera, Guillemaut and Hilton 2013, IEEE TVCG (001 eq 3 and section 3.1.2; 004 eqs 3.6-3.8).
    Departure: hierarchical corrections (each is what the coarser ones leave), simplices for N takes, codes.
    """
    blended = chosen_takes(meshes, takes, "blend.hybrid")
    poses = corresponding_poses(blended, pace, place, "blend.hybrid")
    first = next(iter(blended.values()))
    exact = nonlinear_blends(poses, np.asarray(first.faces))
    built = build_hybrid(poses, exact, epsilon, levels, deepest, codes)
    return blend_space(built, tuple(blended), np.asarray(first.faces), np.asarray(first.fps), epsilon)
