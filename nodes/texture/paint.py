"""Colours fixed to vertices, to look at correspondence."""

from __future__ import annotations

import colorsys
from typing import Annotated, Literal

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.vertex_colours import VertexColours


@node(over="dataset")
def paint(
    meshes: Dataset[MeshSequence],
    *,
    pattern: Annotated[
        Literal["checker", "rainbow"],
        Param("1", about="cubes in two tones, or hue around and lightness upwards"),
    ] = "checker",
    take: Annotated[str, Param("1", about="the take that is painted; empty: the first")] = "",
    frame: Annotated[int, Param("1", 0, 1_000_000, "the frame that is painted")] = 0,
    cell: Annotated[float, Param("m", 0.005, 1, "edge of one cube of the checker")] = 0.06,
) -> VertexColours:
    """Paint one frame by position; the colours then stay on the vertices of every frame and take.

    With p the vertex, c the middle of the frame's bounding box: hue = atan2(x - c_x, z - c_z) / 2 pi,
    lightness grows with height. Checker: darker by half where floor(x / cell) + floor(y / cell) + floor(z /
    cell) is odd. A good alignment shows a pattern that does not swim.

    Raises ValueError where the take or frame does not exist, or the takes differ in topology.

    Source: 004 figure 2.4 (patches coloured on the root mesh and followed through aligned sequences).
    """
    name = take or next(iter(meshes), "")
    if name not in meshes:
        raise ValueError(f"texture.paint: take must be one of {list(meshes)}, got {name!r}")
    mesh = meshes[name]
    count = mesh.vertices.shape[0]
    if frame >= count:
        raise ValueError(f"texture.paint: frame must be under {count} (take {name!r}), got {frame}")
    for other, sequence in meshes.items():
        if not np.array_equal(np.asarray(sequence.faces), np.asarray(mesh.faces)):
            raise ValueError(
                f"texture.paint: takes {name!r} and {other!r} must share one topology: paint aligned meshes"
            )
    vertices = np.asarray(mesh.vertices[frame], np.float64)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    middle, height = (low + high) / 2, max(high[1] - low[1], 1e-9)
    hue = np.arctan2(vertices[:, 0] - middle[0], vertices[:, 2] - middle[2]) / (2 * np.pi) % 1.0
    lightness = 0.35 + 0.4 * (vertices[:, 1] - low[1]) / height
    colour = np.array([colorsys.hls_to_rgb(h, v, 0.75) for h, v in zip(hue, lightness, strict=True)])
    if pattern == "checker":
        odd = np.floor((vertices - low) / cell).sum(axis=1).astype(int) % 2 == 1
        colour[odd] *= 0.45
    return VertexColours(np.rint(255 * colour).astype(np.uint8))
