"""The mattes that a perfect key would find."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.antialiased_view import coverage, sample_view
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.footage import Mattes
from reperform.nodes.products.mesh import MeshSequence


@node(over="view")
def true_mattes(
    mesh: MeshSequence,
    cameras: Cameras,
    *,
    supersampling: Annotated[int, Param("samples", 1, 16, "samples along a pixel's edge")] = 4,
) -> Mattes:
    """Share of every pixel that the true surface covers: alpha = hits / s^2, s^2 samples on a regular grid.

    mesh: vertices (V, 3) in metres; cameras with distortion. Returns alpha (height, width), 255 = covered.
    With the supersampling of `studio.film` the alpha is exactly the one it composites with.

    Source: Pineda 1988, SIGGRAPH (coverage by edge functions).
    """
    samples = sample_view(mesh.vertices, mesh.faces, *cameras[:5], supersampling)
    alpha = coverage(samples, cameras.image_size)
    return Mattes(np.rint(255 * alpha).astype(np.uint8), mesh.fps)
