"""A real camera's view, rendered from the other cameras only."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.captured_surface import capture_surface
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.colour_match import ColourMatch
from reperform.nodes.products.footage import Film, Footage, Mattes
from reperform.nodes.products.mesh import MeshSequence, Surfaces
from reperform.nodes.texture.free_viewpoint import calibration, pictures, view_of
from reperform.nodes.texture.parameters import (
    Bias,
    Erode,
    Feather,
    Samples,
    Sharpness,
    check_views,
    one_mesh,
)


@node(over="frame", memory=1.0)
def held_out(
    footage: Footage,
    mattes: Mattes,
    cameras: Cameras,
    mesh: MeshSequence | None = None,
    surfaces: Surfaces | None = None,
    colours: ColourMatch | None = None,
    *,
    camera: Annotated[int, Param("1", 0, 999, "the camera whose picture is not used")] = 0,
    sharpness: Sharpness = 4.0,
    erode: Erode = 1.5,
    feather: Feather = 6.0,
    bias: Bias = 0.003,
    samples: Samples = 3,
    background: Annotated[float, Param("1/255", 0, 255, "grey behind the performer")] = 128.0,
) -> Film:
    """Render what camera k saw from all the others, through camera k's own lens model, over plain grey.

    The film has the size of the footage; `texture.picture_error` compares it with the real view. Weights as
    in `texture.free_viewpoint`. With `colours` wired the film is in camera k's own colours (the three factors
    are all that is taken from its picture).

    Raises ValueError where there is no such camera, or none besides it.

    Source: 004 section 5.3.1 (free-viewpoint rendering), leave-one-out as in Buehler et al. 2001.
    """
    source = one_mesh("texture.held_out", mesh, surfaces)
    check_views("texture.held_out", footage.images, mattes.alpha, cameras.matrix)
    count = len(cameras.matrix)
    if camera >= count or count < 2:
        raise ValueError(
            f"texture.held_out: camera must be one of 0 .. {count - 1}, with others, got {camera}"
        )
    kept = [k for k in range(count) if k != camera]
    gains = None if colours is None else colours.gain[kept]
    views = pictures(footage, mattes, cameras)
    others = [views[k] for k in kept]
    surface = capture_surface(
        source.vertices, source.faces, others, gains=gains, erode=erode, feather=feather, bias=bias
    )
    if colours is not None:
        # In the colours of the camera that is replaced.
        own = colours.gain[camera].astype(np.float64)
        surface = surface._replace(
            gains=surface.gains / own, colours=(surface.colours / own).astype(np.float32)
        )
    grey = np.full(footage.images.shape[1:], background, np.float32)
    picture, coverage = view_of(
        surface, calibration(cameras, camera), grey, samples=samples, sharpness=sharpness, bias=bias
    )
    return Film(picture, coverage, footage.fps)
