"""Bring the colours of the cameras together."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.colour_gain import colour_gain
from reperform.nodes.kernels.mesh_geometry import vertex_normals
from reperform.nodes.kernels.source_view import source_view
from reperform.nodes.kernels.view_dependent import view_dependent_colour
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.colour_match import ColourMatch
from reperform.nodes.products.footage import Footage, Mattes
from reperform.nodes.products.mesh import MeshSequence, Surfaces
from reperform.nodes.texture.free_viewpoint import calibration
from reperform.nodes.texture.parameters import Bias, Erode, Feather, check_views, one_mesh


@node(over="take", memory=2.0)
def colour_match(
    footage: Footage,
    mattes: Mattes,
    cameras: Cameras,
    mesh: MeshSequence | None = None,
    surfaces: Surfaces | None = None,
    *,
    frames: Annotated[int, Param("1", 1, 1000, "frames to look at, spread over the take")] = 5,
    erode: Erode = 1.5,
    feather: Feather = 6.0,
    bias: Bias = 0.003,
) -> ColourMatch:
    """Find factors on red, green and blue of each camera, so that all show the performer in one colour.

    Vertices seen by several cameras (depth test, mattes) tie them together: minimise over log gains g and log
    surface colours m sum w rho(log I + g - m) with Cauchy's rho; the median log gain is 0, so a single
    off-colour camera is brought to the others.

    Raises ValueError where footage, mattes and cameras differ in views, or unless exactly one of mesh and
    surfaces is wired.

    Source: Brown and Lowe 2007, IJCV 74(1), section 6 (gain compensation). Departure: per channel, robust, on
    surface points.
    """
    source = one_mesh("texture.colour_match", mesh, surfaces)
    check_views("texture.colour_match", footage.images[0], mattes.alpha[0], cameras.matrix)
    count, total = len(cameras.matrix), len(source.vertices)
    colours, weights = [], []
    for frame in np.unique(np.linspace(0, total - 1, min(frames, total)).astype(int)).tolist():
        vertices = np.asarray(source.vertices[frame], np.float64)
        faces = source.faces if mesh is not None else source.faces[frame]
        normals = vertex_normals(vertices, faces)
        seen, quality = np.zeros((count, len(vertices), 3)), np.zeros((count, len(vertices)))
        for k in range(count):
            view = source_view(
                footage.images[frame, k],
                mattes.alpha[frame, k],
                vertices,
                faces,
                calibration(cameras, k),
                erode=erode,
                feather=feather,
            )
            if view is not None:
                seen[k], quality[k] = view_dependent_colour(vertices, normals, None, [view], bias=bias)
        colours.append(seen)
        weights.append(quality)
    gain = colour_gain(np.concatenate(colours, axis=1), np.concatenate(weights, axis=1))
    return ColourMatch(gain.astype(np.float32))
