"""Dissimilarity of poses by how the faces of the surface turn and stretch from one to the other."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.deformation_metric import Reference, exact_distances, prepare, reference_pose
from reperform.nodes.kernels.face_clusters import (
    bisect_faces,
    cluster_areas,
    cluster_distances,
    cluster_poses,
)
from reperform.nodes.kernels.mesh_geometry import vertex_areas
from reperform.nodes.kernels.one_topology import require_one_topology
from reperform.nodes.product import Pair
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity

_WHO = "similarity.deformation_gradient"


@node(over="pair", memory=1.0)
def deformation_gradient(
    mesh: Pair[MeshSequence],
    *,
    stretch_weight: Annotated[float, Param("rad", 0.0, 10.0, "what a unit of stretch counts as")] = 0.01,
    clusters: Annotated[
        int, Param("1", 0, 20000, "groups of faces compared by their mean rotation; 0: every face, exactly")
    ] = 400,
    focus: Annotated[
        float,
        Param(
            "m", 0.0, 10.0, "reach about the vertical axis of the body of what lays poses together; 0: all"
        ),
    ] = 0.3,
) -> Dissimilarity:
    """How far every frame of one take is from every frame of the other, in radians: (frame_a, frame_b).

        d(i, j) = sum_m A_m (|log R_m|_F / sqrt 2 + stretch_weight (|S_m - I|_F + |S_m^-1 - I|_F) / 2)

    where T_m = R_m S_m takes face m of i to that of j, j first laid on i by a ground-plane motion (least squares
    over vertices weighted by area and exp(-(r / focus)^2), r the distance from the body's vertical axis), and A_m
    is the face's share of the area, mean of both takes' first frames. With `clusters`, faces are compared by the
    mean rotation of their group and stretch is left out; the bound is that of `cluster_poses`.

    Raises ValueError where the takes differ in topology, or the first frame has no area.

    Source: Boukhayma and Boyer 2015, 3DV (002 eqs 1-3).
    Departure: T acts on column edges (printed, it acts on the wrong side); the normal is as long as the root of
    twice the area, so that scaling is a stretch in all directions alike; shares of area in place of a sum over
    faces, so that the unit is a mean angle and does not depend on the mesh's fineness; stretch both ways, so that
    d(i, j) = d(j, i).
    """
    a, b = mesh
    require_one_topology(_WHO, (a.faces, b.faces), (a.vertices.shape[1], b.vertices.shape[1]))
    faces = np.asarray(a.faces)
    firsts = [np.asarray(take.vertices[0]) for take in mesh]
    try:
        one, other = (reference_pose(v, faces, alignment_weights(v, faces, focus)) for v in firsts)
    except ValueError as error:
        raise ValueError(f"{_WHO}: {error}") from error
    # both takes count alike, so that swapping them transposes
    reference = one._replace(area=(one.area + other.area) / 2, weight=(one.weight + other.weight) / 2)
    label = bisect_faces(firsts[0], faces, clusters) if 0 < clusters < len(faces) else None
    return Dissimilarity(_distances(a, b, reference, label, stretch_weight).astype(np.float32))


def alignment_weights(vertices: np.ndarray, faces: np.ndarray, focus: float) -> np.ndarray:
    """Weights (V,) of the vertices in the ground-plane alignment: most at the trunk, by distance from its axis."""
    area = vertex_areas(vertices, faces)
    if focus <= 0 or not area.sum() > 0:
        return area
    ground = vertices[:, [0, 2]].astype(np.float64)
    away = ground - area @ ground / area.sum()
    return area * np.exp(-np.minimum(np.einsum("vk,vk->v", away, away) / focus**2, 100.0))


def _distances(
    a: MeshSequence, b: MeshSequence, reference: Reference, label: np.ndarray | None, stretch_weight: float
) -> np.ndarray:
    first, second = (prepare(np.asarray(take.vertices), reference) for take in (a, b))
    if label is None:
        return exact_distances(first, second, reference.area, stretch_weight)
    mean, other = (cluster_poses(poses, reference, label, stretch_weight) for poses in (first, second))
    return cluster_distances(mean, other, cluster_areas(reference, label))
