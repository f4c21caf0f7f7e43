"""Shape-colour histogram of each frame's surface."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.mesh_geometry import vertex_areas
from reperform.nodes.kernels.shape_colour_bins import shape_colour_bins
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.shape_colour import ShapeColourHistograms
from reperform.nodes.products.vertex_colours import VertexColours


@node(over="frame")
def shape_colour_histogram(
    mesh: MeshSequence,
    colours: VertexColours,
    *,
    radial: Annotated[int, Param("bins", 1, 64, "shells of equal thickness")] = 5,
    polar: Annotated[int, Param("bins", 1, 90, "equal angles from straight up to straight down")] = 10,
    azimuth: Annotated[int, Param("bins", 1, 360, "equal angles about the vertical")] = 20,
    channel: Annotated[int, Param("bins", 1, 64, "of each of red, green and blue")] = 10,
    reach: Annotated[float, Param("m", 0.05, 10.0, "outer radius of the last shell")] = 1.2,
) -> ShapeColourHistograms:
    """Share of the surface by radius, polar angle, azimuth, red, green and blue, as the sparse list of filled bins.

    H(r, p, k, R, G, B) = area of the surface (m^2) within the bin, around the centre of mass / all of the area. Of
    the 100,000 bins some 1,500 are filled; each keeps the mean position and colour of what it holds.

    Raises ValueError where the colours are of another topology or the surface has no area.

    Source: 000 section 4.1, eq 1.
    Departure: area of the surface in place of counted voxels, so that no grid is needed; bins are represented by
    their means, not their middles (Rubner, Tomasi and Guibas 2000, IJCV 40, signatures).
    """
    vertices, colour = np.asarray(mesh.vertices, np.float64), np.asarray(colours.colour) / 255.0
    if len(colour) != len(vertices):
        raise ValueError(
            f"shape_colour_histogram: colours must be of the {len(vertices)} vertices of the mesh, got "
            f"{len(colour)}: wire the colours of this topology"
        )
    area = vertex_areas(vertices, np.asarray(mesh.faces))
    if not area.sum() > 0:
        raise ValueError("shape_colour_histogram: the surface must have an area (m^2) over 0, got 0")
    centre = area @ vertices / area.sum()
    bins = (radial, polar, azimuth, channel, channel, channel)
    found = shape_colour_bins(vertices - centre, colour, area, bins, reach)
    return ShapeColourHistograms(
        found.bin, found.share, found.point.astype(np.float32), found.colour.astype(np.float32),
        centre.astype(np.float32), np.array(bins, np.int32), np.asarray(reach, np.float32),
    )  # fmt: skip
