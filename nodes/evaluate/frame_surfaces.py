"""Frames of one topology as surfaces, for nodes that take surfaces of any topology."""

from __future__ import annotations

from reperform.nodes.declaration import node
from reperform.nodes.products.mesh import MeshSequence, Surfaces


@node(over="frame")
def frame_surfaces(mesh: MeshSequence) -> Surfaces:
    """Every frame with faces of its own; vertices in metres, as they are.

    Source: definition.
    """
    return Surfaces(mesh.vertices, mesh.faces, mesh.fps)
