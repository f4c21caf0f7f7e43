"""Dissimilarity of skeleton poses."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.ground_plane_distance import Motion, ground_plane_distance, velocity
from reperform.nodes.kernels.joint_weights import joint_weights
from reperform.nodes.kernels.one_topology import require_one_rate
from reperform.nodes.product import Pair
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.products.performance import SkeletonSequence


@node(over="pair", memory=0.5)
def skeleton(
    skeleton: Pair[SkeletonSequence],
    *,
    velocity_weight: Annotated[
        float, Param("1", 0.0, 100.0, "weight of the difference of motion per frame against that of pose")
    ] = 0.0,
    weights: Annotated[dict[str, float], Param(about="weight of joints by name, >= 0; others have 1")] = {},  # noqa: B006
    align: Annotated[
        Motion, Param(about="ground-plane motion that does not count as a difference")
    ] = "yaw_and_offset",
) -> Dissimilarity:
    """How far the joints of every frame of one take are from those of the other, in metres: (frame_a, frame_b).

    d(i, j)^2 = min over a turn about the vertical and a shift on the ground of (sum_p w_p |J_i - J_j|^2 +
    velocity_weight sum_p w_p |V_i - V_j|^2) / sum_p w_p, V(t) = J(t) - J(t - 1) in metres per frame. All pairs at
    once, in closed form.

    Raises ValueError where the takes differ in joints, or in frame rate where velocities count, or a weighted
    joint does not exist.

    Source: 000 section 4.2, fig 4 (skeletal pose); 003 section 3.2.1, eq 5.
    """
    a, b = skeleton
    names = list(map(str, np.asarray(a.names)))
    if names != list(map(str, np.asarray(b.names))):
        raise ValueError(
            f"similarity.skeleton: both takes must have the same joints in one order, got {len(names)} and "
            f"{len(b.names)} of them: take skeletons of one hierarchy"
        )
    share = joint_weights("similarity.skeleton", names, weights)
    if velocity_weight > 0:
        require_one_rate("similarity.skeleton", a.fps, b.fps)
    distance = ground_plane_distance(
        a.joints, b.joints, velocity(a.joints), velocity(b.joints), velocity_weight, align, share
    )
    return Dissimilarity(distance.astype(np.float32))
