"""A mesh sequence at chosen weights of a blend space."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.blend.space_fields import hybrid_fields
from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.hybrid_blend import evaluate, new_scratch
from reperform.nodes.products.blend_space import BlendSpace
from reperform.nodes.products.mesh import MeshSequence


@node(over="dataset")
def pose(
    space: BlendSpace,
    *,
    weights: Annotated[
        tuple[float, ...], Param("1", 0.0, 1.0, "of the space's takes, in their order; sum 1")
    ],
) -> MeshSequence:
    """All poses of a blend space at one weight per take, m.

        x(w) = sum_i w_i x_i + sum_k h_k(w) d_k

    A weight of 1 returns that take to the bit.

    Raises ValueError where the number of weights is not that of the takes, one is negative, or their sum is
    not 1.

    Source: Casas, Tejera, Guillemaut and Hilton 2013, IEEE TVCG (001 eq 3).
    """
    takes = ", ".join(map(str, np.asarray(space.takes)))
    given = np.asarray(weights, np.float64)
    if given.shape != (len(space.takes),):
        raise ValueError(f"blend.pose: one weight per take needed ({takes}), got {len(given)}")
    if (given < 0.0).any() or abs(given.sum() - 1.0) > 1e-6:
        raise ValueError(f"blend.pose: weights of {takes} must be >= 0 with sum 1, got {tuple(weights)}")
    fields = hybrid_fields(space)
    out = np.empty(np.shape(space.vertices)[1:], np.float32)
    scratch = new_scratch(fields)
    for k in range(len(out)):
        evaluate(fields, k, given, out[k], scratch)
    return MeshSequence(out, np.asarray(space.faces), np.asarray(space.fps))
