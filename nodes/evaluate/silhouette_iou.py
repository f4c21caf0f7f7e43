"""How well a surface explains the mattes it was made from."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.silhouette import intersection_over_union, silhouette
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.footage import Mattes
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence, Surfaces
from reperform.nodes.texture.parameters import one_mesh


@node(over="frame")
def silhouette_iou(
    mattes: Mattes, cameras: Cameras, surfaces: Surfaces | None = None, mesh: MeshSequence | None = None
) -> Measures:
    """Intersection over union of a surface's silhouette and the matte, camera by camera.

    IoU_c = |P_c and M_c| / |P_c or M_c|, P_c the pixels whose centre the surface covers when projected through
    camera c's lens model, M_c those with alpha >= 1/2. alpha (camera, y, x); vertices (V, 3) m. One entry per camera.

    Raises ValueError where mattes and cameras differ in number, and unless exactly one surface is wired.
    Source: Jaccard 1912; Everingham et al. 2010, IJCV 88(2).
    """
    body = one_mesh("evaluate.silhouette_iou", mesh, surfaces)
    if len(mattes.alpha) != len(cameras.matrix):
        raise ValueError(
            f"evaluate.silhouette_iou: mattes and cameras must show the same views, got {len(mattes.alpha)} mattes "
            f"and {len(cameras.matrix)} cameras: wire the cameras of this footage"
        )
    shares = [
        intersection_over_union(silhouette(body.vertices, body.faces, *camera, *alpha.shape), alpha >= 128)
        for alpha, *camera in zip(mattes.alpha, *cameras[:4], strict=True)
    ]
    return Measures(np.array(shares), np.asarray(cameras.name), np.full(len(shares), "1"))
