"""Aligned takes with fewer vertices, still of one topology."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.coarse_topology import coarse_topology
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence


@node(over="dataset")
def coarsen(
    meshes: Dataset[MeshSequence],
    *,
    vertices: Annotated[int, Param("1", 100, 1000000, "vertices to keep, about")] = 3000,
) -> Dataset[MeshSequence]:
    """All takes on one coarser topology, made on the first frame of the first take.

    Every coarse vertex is a fixed point of a face: x'(t) = sum_k b_k x_k(t) with its barycentric weights b, so
    that it is the same physical point in all frames of all takes. Takes that have no more vertices than asked
    for stay as they are.

    Raises ValueError where takes differ in topology or the mesh is not closed.

    Source: Garland and Heckbert 1997, SIGGRAPH (edge collapse).
    """
    (name, first), *others = meshes.items()
    faces = np.asarray(first.faces)
    for other, sequence in others:
        if not np.array_equal(faces, np.asarray(sequence.faces)):
            raise ValueError(
                f"align.coarsen: takes must share one topology; {other} differs from {name}: align them first"
            )
    coarse = coarse_topology(np.asarray(first.vertices[0]), faces, vertices)
    return {
        take: MeshSequence(
            coarse.apply(np.asarray(sequence.vertices)), coarse.faces, np.asarray(sequence.fps)
        )
        for take, sequence in meshes.items()
    }
