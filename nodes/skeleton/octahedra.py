"""Skeletons that can be looked at."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.bone_octahedra import bone_octahedra
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.performance import SkeletonSequence


@node(over="take")
def octahedra(
    skeleton: SkeletonSequence,
    *,
    thickness: Annotated[float, Param("1", 0.01, 1, "half the width of a bone over its length")] = 0.12,
    least: Annotated[float, Param("m", 0, 1, "half the width of a short bone")] = 0.02,
) -> MeshSequence:
    """A closed body per bone, so that motion capture can be filmed and exported as a mesh.

    vertices (T, 6 B, 3), m: of every bone its parent, four corners at a `thickness` of its length from the parent
    and from the axis (at `least` so far from the axis), its joint; the corners turn with the bone and not about
    it. Bones shorter than 1 mm in the first frame are left out. Faces are counter-clockwise from outside.

    Raises ValueError where no bone is left.

    Source: the octahedral bones of animation programs; corners carried by rotation minimising frames (Bishop 1975,
    The American Mathematical Monthly).
    """
    joints, parents = np.asarray(skeleton.joints, np.float64), np.asarray(skeleton.parents)
    child = np.flatnonzero(parents >= 0)
    child = child[np.linalg.norm(joints[0, child] - joints[0, parents[child]], axis=-1) >= 1e-3]
    if len(child) == 0:
        raise ValueError(
            f"skeleton.octahedra: at least one bone must be 1 mm long or longer, got {len(parents)} joints without one"
        )
    vertices, faces = bone_octahedra(joints[:, parents[child]], joints[:, child], thickness, least)
    return MeshSequence(vertices.astype(np.float32), faces, np.asarray(skeleton.fps))
