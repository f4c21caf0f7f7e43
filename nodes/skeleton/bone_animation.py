"""Synthesised skeletons where animated meshes are wanted."""

from __future__ import annotations

from reperform.nodes.declaration import node
from reperform.nodes.products.mocap import SkeletalAnimation
from reperform.nodes.products.motion import Animation
from reperform.nodes.skeleton.bones import bones


@node(over="dataset")
def bone_animation(animation: SkeletalAnimation) -> Animation:
    """The same motion and provenance with joints as vertices and bones as triangles without area.

    Source: 003 section 3.2.1 (joints as point clouds; Kovar, Gleicher and Pighin 2002, SIGGRAPH).
    """
    return Animation(bones(animation.mocap.skeleton), animation.provenance)
