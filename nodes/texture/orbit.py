"""A virtual camera that goes around the performer."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from scipy.ndimage import gaussian_filter1d

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.camera import look_at
from reperform.nodes.kernels.mesh_geometry import centroid
from reperform.nodes.products.cameras import CameraPath
from reperform.nodes.products.mesh import MeshSequence, Surfaces
from reperform.nodes.texture.parameters import one_mesh


@node(over="take", memory=1.0)
def orbit(
    mesh: MeshSequence | None = None,
    surfaces: Surfaces | None = None,
    *,
    radius: Annotated[float, Param("m", 0.3, 50, "horizontal distance from the performer")] = 4.0,
    height: Annotated[float, Param("m", -10, 30, "of the camera above the floor")] = 1.5,
    degrees: Annotated[float, Param("deg", -3600, 3600, "turned from the first to the last frame")] = 360.0,
    start: Annotated[
        float, Param("deg", -360, 360, "first direction, about the vertical from +z towards +x")
    ] = 0.0,
    follow: Annotated[bool, Param("1", about="keep the performer in the middle, or stand still")] = True,
    smooth: Annotated[float, Param("s", 0, 10, "over which the performer's path is smoothed")] = 0.5,
    field_of_view: Annotated[float, Param("deg", 1, 150, "vertical")] = 34.0,
    width: Annotated[int, Param("px", 16, 7680, "of the picture")] = 960,
    picture_height: Annotated[int, Param("px", 16, 4320, "of the picture")] = 540,
) -> CameraPath:
    """Film the performer from a circle, upright and aimed at the smoothed centre of the surface.

    c_k: area-weighted centre of frame k, smoothed by a Gaussian (sigma = `smooth`), its height being the mean
    over the take; a_k = start + degrees k / (T - 1); eye_k = (c_k.x + radius sin a_k, height, c_k.z +
    radius cos a_k). With `follow` off c_k is the mean over the take. Focal length = picture_height / 2 /
    tan(field_of_view / 2); the principal point is the picture's centre.

    Raises ValueError unless exactly one of mesh and surfaces is wired, or where a frame has no surface.

    Source: 004 section 5.3.1 (a viewpoint v(t) chosen freely over time).
    """
    source = one_mesh("texture.orbit", mesh, surfaces)
    faces = [source.faces] * len(source.vertices) if mesh is not None else list(source.faces)
    empty = [frame for frame, corners in enumerate(faces) if not len(corners)]
    if empty:
        raise ValueError(
            f"texture.orbit: frame {empty[0]} has no surface to look at: check the step that made it"
        )
    centres = np.stack([centroid(v, f) for v, f in zip(source.vertices, faces, strict=True)])
    if smooth > 0:
        centres = gaussian_filter1d(centres, smooth * float(source.fps), axis=0, mode="nearest")
    centres[:, 1] = centres[:, 1].mean()
    if not follow:
        centres[:] = centres.mean(axis=0)
    return circle(
        centres,
        np.radians(start + degrees * np.arange(len(centres)) / max(len(centres) - 1, 1)),
        radius=radius,
        height=height,
        field_of_view=field_of_view,
        size=(width, picture_height),
    )


def circle(
    centres: np.ndarray,
    angles: np.ndarray,
    *,
    radius: float,
    height: float,
    field_of_view: float,
    size: tuple[int, int],
) -> CameraPath:
    """Poses at `angles` (T,) rad on circles about `centres` (T, 3); height m above the floor, angles in
    deg."""
    around = np.stack([np.sin(angles), np.zeros_like(angles), np.cos(angles)], axis=1)
    eyes = centres * (1, 0, 1) + radius * around + (0, height, 0)
    rotations, translations = zip(*(look_at(e, c) for e, c in zip(eyes, centres, strict=True)), strict=True)
    focal = size[1] / 2 / np.tan(np.radians(field_of_view) / 2)
    matrix = np.array([[focal, 0, (size[0] - 1) / 2], [0, focal, (size[1] - 1) / 2], [0, 0, 1]])
    return CameraPath(
        np.repeat(matrix[None], len(centres), axis=0),
        np.stack(rotations),
        np.stack(translations),
        np.array(size, np.int32),
    )
