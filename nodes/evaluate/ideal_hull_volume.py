"""How small a visual hull could be at best."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.antialiased_view import coverage, sample_view
from reperform.nodes.kernels.matte_hull_volume import matte_hull_volume
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence


@node(over="frame")
def ideal_hull_volume(
    truth: MeshSequence,
    cameras: Cameras,
    *,
    voxel: Annotated[float, Param("m", 0.0005, 0.1, "edge of one voxel")] = 0.0025,
    margin: Annotated[float, Param("m", 0.0, 5.0, "how far around the truth the hull may reach")] = 0.4,
    floor: Annotated[float, Param("m", -100, 100, "height below which nothing is")] = 0.0,
    views: Annotated[int, Param("cameras", 0, 64, "that must see a place; 0: more than half")] = 0,
    supersampling: Annotated[int, Param("samples", 1, 16, "samples along a pixel's edge")] = 4,
) -> Measures:
    """Volume, m^3, of the visual hull of the true mattes: the best that any hull of these cameras can do.

    truth: vertices (V, 3) m of the surface that was filmed; cameras: the rig. The true surface is rendered to
    antialiased mattes; the volume is that of all voxels of the box around the truth, widened by `margin` and cut
    at the floor, whose centre every camera that sees it shows covered (bilinear coverage >= 1/2). It is at least
    the volume of the truth, up to the voxels. Entry `volume`.

    Source: Laurentini 1994, PAMI 16(2) (visual hull). The cells are settled coarse to fine; the count is the same.
    """
    size = np.asarray(cameras.image_size)
    if (size != size[0]).any():
        raise ValueError(
            f"evaluate.ideal_hull_volume: all cameras need pictures of one size, got {size.tolist()}: scale them"
        )
    views_of = zip(*cameras[:4], size, strict=True)
    alpha = np.stack(
        [
            np.rint(255 * coverage(sample_view(truth.vertices, truth.faces, *view, supersampling), view[-1]))
            for view in views_of
        ]
    ).astype(np.uint8)
    low = np.asarray(truth.vertices, np.float64).min(axis=0) - margin
    high = np.asarray(truth.vertices, np.float64).max(axis=0) + margin
    low[1] = max(low[1], floor)
    found = matte_hull_volume(alpha, cameras[:4], low, high, voxel, views or len(alpha) // 2 + 1)
    return Measures(np.array([found]), np.array(["volume"]), np.array(["m^3"]))
