"""One captured moment, filmed by a camera that goes all the way round."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.backdrop import backdrop
from reperform.nodes.kernels.captured_surface import capture_surface
from reperform.nodes.kernels.mesh_geometry import centroid
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.colour_match import ColourMatch
from reperform.nodes.products.footage import Film, Footage, Mattes
from reperform.nodes.products.mesh import MeshSequence, Surfaces
from reperform.nodes.texture.free_viewpoint import calibration, view_of
from reperform.nodes.texture.orbit import circle
from reperform.nodes.texture.parameters import (
    Bias,
    Brightness,
    Erode,
    Feather,
    Grid,
    Samples,
    Shadow,
    Sharpness,
    check_views,
    one_mesh,
)


@node(over="take", memory=2.0)
def turntable(
    footage: Footage,
    mattes: Mattes,
    cameras: Cameras,
    mesh: MeshSequence | None = None,
    surfaces: Surfaces | None = None,
    colours: ColourMatch | None = None,
    *,
    frame: Annotated[int, Param("1", 0, 1_000_000, "the captured frame")] = 0,
    views: Annotated[int, Param("1", 1, 3600, "pictures of one turn")] = 60,
    fps: Annotated[float, Param("Hz", 1, 240, "of the film")] = 25.0,
    radius: Annotated[float, Param("m", 0.3, 50, "horizontal distance from the performer")] = 4.0,
    height: Annotated[float, Param("m", -10, 30, "of the camera above the floor")] = 1.5,
    start: Annotated[
        float, Param("deg", -360, 360, "first direction, about the vertical from +z towards +x")
    ] = 0.0,
    field_of_view: Annotated[float, Param("deg", 1, 150, "vertical")] = 34.0,
    width: Annotated[int, Param("px", 16, 7680, "of the picture")] = 960,
    picture_height: Annotated[int, Param("px", 16, 4320, "of the picture")] = 540,
    sharpness: Sharpness = 4.0,
    erode: Erode = 1.5,
    feather: Feather = 6.0,
    bias: Bias = 0.003,
    samples: Samples = 3,
    brightness: Brightness = 0.75,
    shadow: Shadow = 0.5,
    grid: Grid = 1.0,
) -> Film:
    """Film one captured frame by a camera that goes once round: a film that loops.

    `views` pictures, 360 / views degrees apart. Rendering as in `texture.free_viewpoint`, camera as in
    `texture.orbit`.

    Raises ValueError where the frame does not exist, footage, mattes and cameras differ in views, or unless
    exactly one of mesh and surfaces is wired.

    Source: 004 section 5.2 step 3 (free-viewpoint rendering of a captured frame).
    """
    source = one_mesh("texture.turntable", mesh, surfaces)
    if frame >= len(source.vertices) or frame >= len(footage.images):
        count = min(len(source.vertices), len(footage.images))
        raise ValueError(f"texture.turntable: frame must be under {count}, got {frame}")
    images, alpha = footage.images[frame], mattes.alpha[frame]
    check_views("texture.turntable", images, alpha, cameras.matrix)
    vertices = source.vertices[frame]
    faces = source.faces if mesh is not None else source.faces[frame]
    shots = [(images[k], alpha[k], calibration(cameras, k)) for k in range(len(images))]
    surface = capture_surface(
        vertices,
        faces,
        shots,
        gains=None if colours is None else colours.gain,
        erode=erode,
        feather=feather,
        bias=bias,
    )
    path = circle(
        np.repeat(centroid(vertices, faces)[None], views, axis=0),
        np.radians(start) + 2 * np.pi * np.arange(views) / views,
        radius=radius,
        height=height,
        field_of_view=field_of_view,
        size=(width, picture_height),
    )
    film = np.empty((views, picture_height, width, 3), np.uint8)
    coverage = np.empty((views, picture_height, width), np.uint8)
    for k in range(views):
        pose = path.matrix[k], path.rotation[k], path.translation[k]
        stage = backdrop(
            *pose,
            picture_height,
            width,
            surface.vertices,
            surface.faces,
            brightness=brightness,
            shadow=shadow,
            grid=grid,
        )
        film[k], coverage[k] = view_of(surface, pose, stage, samples=samples, sharpness=sharpness, bias=bias)
    return Film(film, coverage, np.asarray(fps, np.float32))
