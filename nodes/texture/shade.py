"""Shaded pictures of a mesh that has no footage."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.backdrop import LIGHT, backdrop
from reperform.nodes.kernels.camera import centre, project
from reperform.nodes.kernels.captured_surface import compose, directions_to
from reperform.nodes.kernels.mesh_geometry import vertex_normals
from reperform.nodes.kernels.rasterise import interpolate
from reperform.nodes.kernels.soft_shade import soft_shade
from reperform.nodes.kernels.surface_hits import surface_hits
from reperform.nodes.products.cameras import CameraPath
from reperform.nodes.products.footage import Film
from reperform.nodes.products.mesh import MeshSequence, Surfaces
from reperform.nodes.products.vertex_colours import VertexColours
from reperform.nodes.texture.parameters import Brightness, Grid, Samples, Shadow, one_mesh


@node(over="frame", memory=0.5)
def shade(
    camera: CameraPath,
    mesh: MeshSequence | None = None,
    surfaces: Surfaces | None = None,
    colours: VertexColours | None = None,
    *,
    colour: Annotated[list[float], Param("1", 0, 1, "red, green, blue of a mesh without vertex colours")] = [  # noqa: B006
        0.84,
        0.78,
        0.70,
    ],
    samples: Samples = 3,
    brightness: Brightness = 0.75,
    shadow: Shadow = 0.5,
    grid: Grid = 1.0,
) -> Film:
    """Render a frame in soft light, with its shadow on the floor.

    Lit colour = albedo (0.36 + 0.14 n_y + 0.42 lit max(0, n . l) + 0.30 n . v + 0.10 (1 - n . v)^3) with the albedo
    `colour` or, where wired, the vertex colours of `texture.paint`, which stay on the surface and so show
    how well it is aligned.

    Raises ValueError unless exactly one of mesh and surfaces is wired, where the colours are of another
    topology, or `colour` is not three shares.

    Source: Lambert's law; Reeves, Salesin and Cook 1987, SIGGRAPH (percentage-closer shadows).
    """
    source = one_mesh("texture.shade", mesh, surfaces)
    vertices, faces = np.asarray(source.vertices, np.float64), np.asarray(source.faces)
    if len(colour) != 3:
        raise ValueError(f"texture.shade: colour must be red, green, blue in 0..1, got {list(colour)}")
    if colours is not None and len(colours.colour) != len(vertices):
        raise ValueError(
            f"texture.shade: colours must be of the {len(vertices)} vertices, got {len(colours.colour)}: "
            "wire the paint of this aligned mesh"
        )
    width, height = camera.image_size.tolist()
    pose = camera.matrix, camera.rotation, camera.translation
    stage = backdrop(*pose, height, width, vertices, faces, brightness=brightness, shadow=shadow, grid=grid)
    hits = surface_hits(*project(vertices, *pose), faces, height, width, samples)
    points = interpolate(vertices, faces, hits.ids, hits.barycentric)
    normals = interpolate(vertex_normals(vertices, faces), faces, hits.ids, hits.barycentric)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    albedo = (
        np.broadcast_to(255 * np.asarray(colour, np.float64), points.shape)
        if colours is None
        else interpolate(colours.colour, faces, hits.ids, hits.barycentric)
    )
    towards = directions_to(centre(camera.rotation, camera.translation), points)
    lit = soft_shade(points, normals, towards, albedo, vertices, faces, LIGHT) if len(points) else albedo
    return Film(*compose(stage, hits.y, hits.x, lit, hits.coverage), source.fps)
