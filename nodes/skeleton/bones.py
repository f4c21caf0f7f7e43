"""Skeletons where meshes are wanted."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.bone_mesh import bone_faces
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.performance import SkeletonSequence


@node(over="take")
def bones(skeleton: SkeletonSequence) -> MeshSequence:
    """Joints as vertices and bones as triangles without area: what works on meshes works on skeletons.

    vertices (T, J, 3), m; one face (parent, joint, joint) per bone, so that one hierarchy is one topology.
    Source: 003 section 3.2.1 (joints as point clouds; Kovar, Gleicher and Pighin 2002, SIGGRAPH).
    """
    return MeshSequence(
        np.asarray(skeleton.joints, np.float32),
        bone_faces(np.asarray(skeleton.parents)),
        np.asarray(skeleton.fps),
    )
