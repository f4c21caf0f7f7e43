"""A triangle mesh of the occupied volume."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.decimate import decimate
from reperform.nodes.kernels.flying_edges import isosurface as extract
from reperform.nodes.kernels.largest_component import largest_component
from reperform.nodes.kernels.taubin import taubin_smooth
from reperform.nodes.products.mesh import Occupancy, Surfaces


@node(over="frame")
def isosurface(
    occupancy: Occupancy,
    *,
    level: Annotated[float, Param("1", 0.01, 0.99, "probability on the surface")] = 0.5,
    vertices: Annotated[int, Param("vertices", 0, 10_000_000, "kept at most; 0: all")] = 4000,
    smoothing: Annotated[int, Param("iterations", 0, 100, "of shrinkage-free smoothing")] = 6,
) -> Surfaces:
    """The surface of the performer: watertight, one component, counter-clockwise from outside, in metres.

    probability (x, y, z) -> vertices (V, 3), faces (F, 3). The surface p = `level` of the trilinear field by flying
    edges, its part of largest volume, Taubin smoothing (which takes the grid's steps, not the volume), quadric
    edge collapse down to `vertices`.

    Raises ValueError where nothing reaches `level`.
    Source: 003 section 2.2 (marching cubes); Schroeder et al. 2015, LDAV (flying edges); Taubin 1995, SIGGRAPH;
    Garland and Heckbert 1997, SIGGRAPH (quadrics).
    """
    field = np.asarray(occupancy.probability)
    if not (field > level).any():
        raise ValueError(
            f"isosurface: no voxel is more probable than level {level}, the largest is {field.max(initial=0):.3g}: "
            "lower level, allow misses in surface.occupancy, or check the mattes"
        )
    points, faces = largest_component(*extract(field, level))
    points = taubin_smooth(points, faces, smoothing)
    if vertices and len(points) > vertices:
        points, faces = decimate(points, faces, vertices)
    world = np.asarray(occupancy.origin, np.float64) + float(occupancy.voxel) * points
    return Surfaces(world.astype(np.float32), faces.astype(np.int32), occupancy.fps)
