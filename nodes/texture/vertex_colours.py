"""The colour of every vertex, from the picture painted on its mesh."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.atlas_colour import face_colours
from reperform.nodes.kernels.mesh_geometry import vertex_means
from reperform.nodes.products.mesh import MeshSequence, TextureAtlas
from reperform.nodes.products.vertex_colours import VertexColours


@node(over="take", memory=0.5)
def vertex_colours(
    mesh: MeshSequence,
    texture: TextureAtlas,
    *,
    samples: Annotated[int, Param("1", 1, 16, "points per edge of a face at which the picture is read")] = 4,
    smooth: Annotated[
        int, Param("1", 0, 100, "sweeps in which a vertex takes the mean of the faces around it")
    ] = 2,
) -> VertexColours:
    """The mean colour of the picture around each vertex: (vertex, 3).

    Each face has the mean of the picture at the middles of samples^2 equal parts; each vertex the mean of its
    faces; in each sweep faces then take the mean of their corners, and vertices that of their faces.

    Raises ValueError where the picture is not of this mesh.

    Source: definition.
    """
    if len(texture.faces_uv) != len(mesh.faces):
        raise ValueError(
            f"texture.vertex_colours: the picture must be of the {len(mesh.faces)} faces of the mesh, got "
            f"{len(texture.faces_uv)}: wire the texture of this mesh"
        )
    faces, count = np.asarray(mesh.faces), mesh.vertices.shape[1]
    colour = vertex_means(face_colours(texture.uv, texture.faces_uv, texture.image, samples), faces, count)
    for _ in range(smooth):
        colour = vertex_means(colour[faces].mean(axis=1), faces, count)
    return VertexColours(np.rint(np.clip(colour, 0, 255)).astype(np.uint8))
