"""Captured frames from viewpoints where no camera was."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.backdrop import backdrop
from reperform.nodes.kernels.camera import centre, project
from reperform.nodes.kernels.captured_surface import (
    CapturedSurface,
    capture_surface,
    compose,
    directions_to,
    textured,
)
from reperform.nodes.kernels.rasterise import interpolate
from reperform.nodes.kernels.surface_hits import surface_hits
from reperform.nodes.products.cameras import CameraPath, Cameras
from reperform.nodes.products.colour_match import ColourMatch
from reperform.nodes.products.footage import Film, Footage, Mattes
from reperform.nodes.products.mesh import MeshSequence, Surfaces
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


@node(over="frame", memory=1.0)
def free_viewpoint(
    footage: Footage,
    mattes: Mattes,
    cameras: Cameras,
    camera: CameraPath,
    mesh: MeshSequence | None = None,
    surfaces: Surfaces | None = None,
    colours: ColourMatch | None = None,
    *,
    sharpness: Sharpness = 4.0,
    erode: Erode = 1.5,
    feather: Feather = 6.0,
    bias: Bias = 0.003,
    samples: Samples = 3,
    brightness: Brightness = 0.75,
    shadow: Shadow = 0.5,
    grid: Grid = 1.0,
) -> Film:
    """Render a captured frame from a virtual camera, textured by the footage.

    Each pixel's surface point (rasterised mesh) is looked up in every camera that sees it (depth test) and
    the colours are blended: colour = sum_c w_c I_c / sum_c w_c, w_c = visible_c trust_c facing_c /
    (angle_c + 0.03)^sharpness, angle_c between the directions to the virtual and to the real camera; trust
    fades towards outlines, matte edges and depth jumps, so that no backing colour bleeds in. What no camera
    sees takes the colour of the surface around it. Lens distortion of the sources is respected; `colours`
    brings the cameras' colours together first.

    Raises ValueError where footage, mattes and cameras differ in views, or unless one mesh is wired.

    Source: 004 section 5.2 step 3; Debevec, Yu and Borshukov 1998, EGRW; Buehler et al. 2001, SIGGRAPH.
    Departure: holes take diffused surface colours, not interpolated picture colours: steady from view to
    view.
    """
    source = one_mesh("texture.free_viewpoint", mesh, surfaces)
    check_views("texture.free_viewpoint", footage.images, mattes.alpha, cameras.matrix)
    surface = capture_surface(
        source.vertices,
        source.faces,
        pictures(footage, mattes, cameras),
        gains=None if colours is None else colours.gain,
        erode=erode,
        feather=feather,
        bias=bias,
    )
    width, height = camera.image_size.tolist()
    stage = backdrop(
        camera.matrix,
        camera.rotation,
        camera.translation,
        height,
        width,
        surface.vertices,
        surface.faces,
        brightness=brightness,
        shadow=shadow,
        grid=grid,
    )
    pose = camera.matrix, camera.rotation, camera.translation
    picture, coverage = view_of(surface, pose, stage, samples=samples, sharpness=sharpness, bias=bias)
    return Film(picture, coverage, footage.fps)


def pictures(
    footage: Footage, mattes: Mattes, cameras: Cameras
) -> list[tuple[np.ndarray, np.ndarray, tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]]]:
    """One frame's pictures, mattes and calibrations, camera by camera."""
    return [(footage.images[k], mattes.alpha[k], calibration(cameras, k)) for k in range(len(footage.images))]


def calibration(cameras: Cameras, k: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Matrix, rotation, translation and distortion of camera k."""
    return cameras.matrix[k], cameras.rotation[k], cameras.translation[k], cameras.distortion[k]


def view_of(
    surface: CapturedSurface,
    pose: tuple[np.ndarray, ...],
    background: np.ndarray,
    *,
    samples: int,
    sharpness: float,
    bias: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Picture and coverage of a captured surface; pose: matrix, rotation, translation and maybe
    distortion."""
    height, width = background.shape[:2]
    hits = surface_hits(*project(surface.vertices, *pose), surface.faces, height, width, samples)
    points = interpolate(surface.vertices, surface.faces, hits.ids, hits.barycentric)
    towards = directions_to(centre(pose[1], pose[2]), points)
    colour, _ = textured(surface, hits.ids, hits.barycentric, towards, sharpness=sharpness, bias=bias)
    return compose(background, hits.y, hits.x, colour, hits.coverage)
