"""Parameters that the nodes of this station share, and the one mesh among their two optional inputs."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param
from reperform.nodes.products.mesh import MeshSequence, Surfaces

Sharpness = Annotated[
    float,
    Param("1", 0.5, 16, "how strongly the cameras nearest the virtual one win; low = smoother, blurrier"),
]
Erode = Annotated[float, Param("px", 0, 20, "rim of the performer in the source pictures that is never used")]
Feather = Annotated[float, Param("px", 0.5, 60, "width over which a source picture fades in from its rim")]
Bias = Annotated[float, Param("m", 0.0005, 0.1, "how far behind a depth map a point still counts as seen")]
Samples = Annotated[int, Param("1", 1, 5, "points per pixel and axis for antialiased outlines")]
Brightness = Annotated[float, Param("1", 0, 1, "of the stage behind the performer")]
Shadow = Annotated[float, Param("1", 0, 1, "darkness of the shadow on the floor; 0 = none")]
Grid = Annotated[float, Param("m", 0, 10, "distance between the lines on the floor; 0 = none")]


def one_mesh(who: str, mesh: MeshSequence | None, surfaces: Surfaces | None) -> MeshSequence | Surfaces:
    """The one of the two that is wired. Raises ValueError where none or both are."""
    if mesh is not None and surfaces is None:
        return mesh
    if surfaces is not None and mesh is None:
        return surfaces
    number = "neither" if mesh is None else "both"
    raise ValueError(f"{who}: exactly one of the inputs 'mesh' and 'surfaces' must be wired, got {number}")


def check_views(who: str, images: np.ndarray, alpha: np.ndarray, cameras: np.ndarray) -> None:
    """Raise ValueError unless pictures (camera, y, x, 3), mattes (camera, y, x) and cameras agree."""
    if images.shape[:3] != alpha.shape or len(images) != len(cameras):
        raise ValueError(
            f"{who}: footage, mattes and cameras must show the same views, got {images.shape}, "
            f"{alpha.shape} and {len(cameras)} cameras: wire the mattes and cameras of this footage"
        )
