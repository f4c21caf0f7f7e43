"""Skeletal motion whose joints' rotations are known."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes
from reperform.nodes.products.motion import Provenance
from reperform.nodes.products.performance import SkeletonSequence


class Mocap(NamedTuple):
    """Joints that hang on each other by bones of constant length.

    joint = joint of its parent + rotation of its parent times its offset; joint 0 is the root. Joints that only
    end a bone are named `PARENT_end`.
    """

    skeleton: SkeletonSequence
    # of everything that hangs on a joint, rest to world
    rotation: Annotated[np.ndarray, Axes("frame", "joint", "3", "3")]
    # from the parent, at rest
    offset: Annotated[np.ndarray, Axes("joint", "3", unit="m")]


class SkeletalAnimation(NamedTuple):
    """Synthesised skeletal motion and where every frame comes from."""

    mocap: Mocap
    provenance: Provenance
