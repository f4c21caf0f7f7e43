"""How a product is to be shown."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from reperform.nodes.products.mesh import TextureAtlas
from reperform.nodes.products.motion import MotionGraph

Surface = Literal["shaded", "textured", "checker"]


@dataclass(frozen=True)
class View:
    """Where the eye is: it circles a target.

    azimuth: radians from +z towards +x.  elevation: radians above the horizon.  target: metres, None = the
    middle of what is shown.  distance: metres, None = so that everything fits.  opening: vertical field of
    view, radians.
    """

    azimuth: float = 0.45
    elevation: float = 0.16
    target: tuple[float, float, float] | None = None
    distance: float | None = None
    opening: float = 0.5


@dataclass(frozen=True)
class Look:
    """Size, view and finish of a picture, and what else is known about the product.

    size: width, height in pixels.
    surface: finish of meshes; `textured` falls back to shaded without an atlas that fits, `checker` paints
        the reference positions, so that correspondence can be seen.
    atlas: painted on meshes with as many faces.
    reference: (V, 3) rest positions for the checker, the first frame otherwise.
    graph, pair: the transitions to mark in the matrix of this pair of takes.
    camera: show this one only.
    tracks: take -> (frames, 3) centroids in metres, which place a motion path on the ground.
    """

    size: tuple[int, int] = (960, 720)
    view: View = field(default_factory=View)
    surface: Surface = "shaded"
    atlas: TextureAtlas | None = None
    reference: np.ndarray | None = None
    graph: MotionGraph | None = None
    pair: tuple[str, str] | None = None
    camera: int | None = None
    tracks: Mapping[str, np.ndarray] | None = None
    title: str = ""
