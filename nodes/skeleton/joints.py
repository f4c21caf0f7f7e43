"""A skeleton from body parts marked on a mesh."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.mesh_geometry import vertex_areas
from reperform.nodes.kernels.part_joints import centre_map, part_tree, ring_map
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.part_labels import PartLabels
from reperform.nodes.products.performance import SkeletonSequence

_WHO = "skeleton.joints"


@node(over="take")
def joints(
    mesh: MeshSequence,
    labels: PartLabels,
    *,
    place: Annotated[
        Literal["centre", "ring"],
        Param(about="joints at the centres of parts, or where parts meet the part they hang on"),
    ] = "centre",
    root: Annotated[str, Param(about="the part that all others hang on; empty: the largest")] = "",
) -> SkeletonSequence:
    """The skeletal pose of every frame: one joint per part, (T, J, 3), m.

        joint_j(t) = sum_v w_jv x_v(t),   w_j the share of vertex v of part j (by area) or of the ring of part j

    Labels are marked on one mesh; since all frames share its topology they hold for every frame. With rings, the
    root stands at its centre. Parts hang on each other as they touch on the surface, parents before children;
    parts that touch nothing are left out.

    Raises ValueError where labels do not fit the mesh or no part has the name of the root.
    Source: Huang, Tejera, Collomosse and Hilton 2015, ACM TOG (000 section 3: centres of labelled vertex sets).
    Departure: vertices count by area, so that dense regions do not pull; joints at rings are anatomical joints.
    """
    vertices, faces, label = np.asarray(mesh.vertices), np.asarray(mesh.faces), np.asarray(labels.label)
    names = [str(name) for name in np.asarray(labels.names)]
    if len(label) != vertices.shape[1]:
        raise ValueError(
            f"{_WHO}: labels must be of the mesh's topology, {vertices.shape[1]} vertices, got {len(label)}"
        )
    if root and root not in names:
        raise ValueError(f"{_WHO}: root {root!r} must be one of {', '.join(names)}")
    areas = vertex_areas(vertices[0].astype(np.float64), faces)
    sizes = np.bincount(label[label >= 0], areas[label >= 0], len(names))
    order, parent = part_tree(label, faces, len(names), names.index(root) if root else int(sizes.argmax()))
    weights = centre_map(label, len(names), areas)
    if place == "ring":
        rings = ring_map(label, faces, parent)
        weights = rings + weights.multiply((np.arange(len(names)) == order[0])[:, None])
    chosen = weights.tocsr()[order]
    positions = np.stack([chosen @ frame.astype(np.float64) for frame in vertices])
    number = {int(part): k for k, part in enumerate(order)}
    parents = np.array([number.get(int(parent[part]), -1) for part in order], np.int32)
    return SkeletonSequence(
        positions.astype(np.float32), parents, np.array(names)[order], np.asarray(mesh.fps, np.float32)
    )
