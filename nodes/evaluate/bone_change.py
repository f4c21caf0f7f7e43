"""Whether the bones of a synthesised skeleton stretch."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mocap import SkeletalAnimation


@node(over="dataset")
def bone_change(animation: SkeletalAnimation) -> Measures:
    """Greatest |l(t) / l - 1| over the bones of every frame, l their length at rest.

    Source: definition.
    """
    moving = animation.mocap
    joints, parents = np.asarray(moving.skeleton.joints, np.float64), np.asarray(moving.skeleton.parents)
    rest = np.linalg.norm(np.asarray(moving.offset, np.float64), axis=1)
    bones = np.flatnonzero(rest > 1e-6)
    length = np.linalg.norm(joints[:, bones] - joints[:, parents[bones]], axis=2)
    change = np.abs(length / rest[bones] - 1.0).max(axis=1)
    return Measures(change[:, None], np.array(["bone change"]), np.array(["1"]))
