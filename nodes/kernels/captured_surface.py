"""A captured mesh with the pictures of its frame: it can be asked for the colour of any of its points."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.mesh_geometry import vertex_normals
from reperform.nodes.kernels.rasterise import interpolate
from reperform.nodes.kernels.source_view import SourceView, source_view
from reperform.nodes.kernels.vertex_colour import vertex_colour
from reperform.nodes.kernels.view_dependent import view_dependent_colour

# Below this reliability a pixel fades into the vertex colours.
FILL = 0.01

Picture = tuple[np.ndarray, np.ndarray, tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]]


class CapturedSurface(NamedTuple):
    """One captured frame: mesh, pictures, and a colour per vertex for what no camera sees well."""

    vertices: np.ndarray  # (V, 3) m
    faces: np.ndarray  # (F, 3)
    normals: np.ndarray  # (V, 3)
    views: tuple[SourceView, ...]
    gains: np.ndarray  # (views, 3)
    colours: np.ndarray  # (V, 3) float32, 0..255


def capture_surface(
    vertices: np.ndarray,
    faces: np.ndarray,
    pictures: Iterable[Picture],
    *,
    gains: np.ndarray | None = None,
    erode: float = 1.5,
    feather: float = 6.0,
    bias: float = 0.003,
) -> CapturedSurface:
    """Prepare a captured frame for texturing.

    pictures: per camera image (H, W, 3) uint8, alpha (H, W) uint8 and (matrix, rotation, translation,
    distortion); gains (cameras, 3): factors that bring the cameras' colours together.
    """
    vertices = np.asarray(vertices, np.float64)
    normals = vertex_normals(vertices, faces)
    views, kept = [], []
    for index, (image, alpha, camera) in enumerate(pictures):
        view = source_view(image, alpha, vertices, faces, camera, erode=erode, feather=feather)
        if view is not None:
            views.append(view)
            kept.append(np.ones(3) if gains is None else gains[index])
    factors = np.array(kept, np.float64).reshape(-1, 3)
    colours = vertex_colour(vertices, faces, normals, views, bias=bias, gains=factors)
    return CapturedSurface(vertices, np.asarray(faces, np.int32), normals, tuple(views), factors, colours)


def textured(
    surface: CapturedSurface,
    ids: np.ndarray,
    barycentric: np.ndarray,
    towards: np.ndarray,
    *,
    sharpness: float = 4.0,
    bias: float = 0.003,
) -> tuple[np.ndarray, np.ndarray]:
    """Colours (P, 3) float32 and reliability (P,) of points given by triangle (P,) and barycentrics (P, 3).

    towards (P, 3): unit directions to the virtual eye, in the space of the capture. With r = min(1,
    reliability / 0.01): r view-dependent colour + (1 - r) vertex colour.
    """
    attributes = np.concatenate([surface.vertices, surface.normals, surface.colours], axis=1)
    points, normals, fill = np.split(interpolate(attributes, surface.faces, ids, barycentric), 3, axis=1)
    normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    colour, reliability = view_dependent_colour(
        points, normals, towards, surface.views, sharpness=sharpness, bias=bias, gains=surface.gains
    )
    share = np.minimum(1, reliability / FILL)[:, None]
    filled = share * colour + (1 - share) * fill
    return filled.astype(np.float32), reliability


def directions_to(eye: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Unit vectors (P, 3) from points (P, 3) to an eye (3,)."""
    towards = eye - points
    return np.asarray(towards / np.maximum(np.linalg.norm(towards, axis=1, keepdims=True), 1e-12))


def compose(
    background: np.ndarray, y: np.ndarray, x: np.ndarray, colour: np.ndarray, coverage: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Lay P coloured pixels over a background (H, W, 3): picture uint8 and coverage (H, W) uint8."""
    picture = background.astype(np.float32, copy=True)
    picture[y, x] += coverage[:, None] * (colour - picture[y, x])
    cover = np.zeros(background.shape[:2], np.uint8)
    cover[y, x] = np.rint(255 * coverage)
    return np.rint(np.clip(picture, 0, 255)).astype(np.uint8), cover
