"""A character that follows a drawn path round obstacles."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.bezier import curve_of, through
from reperform.nodes.kernels.obstacle_path import Obstacles, around_obstacles
from reperform.nodes.product import Dataset
from reperform.nodes.products.parametric import ParametricGraph, ParametricSpace
from reperform.nodes.products.played import Played
from reperform.nodes.products.space_corrections import SpaceCorrections
from reperform.nodes.synthesis.cell_corrections import Blending
from reperform.nodes.synthesis.character import Character
from reperform.nodes.synthesis.character_data import character_data
from reperform.nodes.synthesis.path_pilot import PathPilot
from reperform.nodes.synthesis.recording import record

_WHO = "synthesis.play_path"


@node(over="dataset", memory=2.0)
def play_path(
    graph: ParametricGraph,
    spaces: Dataset[ParametricSpace],
    corrections: Dataset[SpaceCorrections] | None = None,
    *,
    points: Annotated[
        tuple[str, ...], Param("m", about="X Z of points that the path goes through, two or more")
    ],
    space: Annotated[str, Param(about="space that walks it, with the parameters speed and turning")],
    circles: Annotated[tuple[str, ...], Param("m", about="obstacles: X Z RADIUS")] = (),
    boxes: Annotated[
        tuple[str, ...], Param("m", about="obstacles: X Z HALF_WIDTH HALF_DEPTH YAW (rad)")
    ] = (),
    margin: Annotated[float, Param("m", 0.0, 3.0, "kept from obstacles")] = 0.4,
    fps: Annotated[float, Param("Hz", 5.0, 240.0, "frames per second")] = 25.0,
    blend: Annotated[float, Param("s", 0.05, 2.0, "length of a transition")] = 0.3,
    blending: Annotated[
        Blending, Param(about="of meshes; hybrid: corrected where `corrections` are given, else linear")
    ] = "linear",
) -> Played:
    """Follow a smooth path through points on the ground, past obstacles, until it ends.

    The path is a chain of cubic Bezier curves, bent where it comes nearer than `margin` to an obstacle. At every step
    the pilot turns the character's position, heading and speed into speed and turning rate within what the space can.
    `way` of the result is the path that was followed.

    Raises ValueError where points or obstacles cannot be read, an end of the path is at an obstacle, or the space has
    not the parameters speed and turning.

    Source: 004 section 4.5.1 (a path drawn by the user, obstacles avoided).
    """
    data = character_data(graph, spaces, corrections, blending)
    places = _numbers(points, 2, "points")
    if len(places) < 2:
        raise ValueError(f"{_WHO}: a path needs two points X Z or more, got {len(places)}")
    obstacles = Obstacles(_numbers(circles, 3, "circles"), _numbers(boxes, 5, "boxes"))
    curve = around_obstacles(curve_of(through(places)), obstacles, margin)
    (x, z), (tx, tz) = curve.point[0], curve.tangent[0]
    walks = data.space(space)
    character = Character(data, walks, (float(x), float(z), float(np.arctan2(tx, tz))), blend=blend)
    pilot = PathPilot(character, curve, walks)
    limit = 3.0 * curve.length / pilot.slowest + 5.0
    return record(character, pilot.command, limit, fps).product(curve.point)


def _numbers(rows: tuple[str, ...], count: int, what: str) -> np.ndarray:
    try:
        values = [[float(word) for word in row.split()] for row in rows]
    except ValueError as error:
        raise ValueError(f"{_WHO}: {what} must be numbers, got {'; '.join(rows)}") from error
    if any(len(row) != count or not np.isfinite(row).all() for row in values):
        raise ValueError(f"{_WHO}: each of {what} is {count} numbers, got {'; '.join(rows)}")
    return np.array(values).reshape(-1, count)
