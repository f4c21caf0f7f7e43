"""How far a character strays from its path."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.bezier import polyline_distance
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.played import Played


@node(over="take")
def way_error(played: Played) -> Measures:
    """Distance of the character's ground point to the path that it follows, m, frame by frame; entry `error`.

    Raises ValueError where there was no path to follow.
    Source: definition.
    """
    way = np.asarray(played.way)
    if len(way) < 2:
        raise ValueError(
            "evaluate.way_error: the motion followed no path: wire what synthesis.play_path made, not play_script"
        )
    distance = polyline_distance(way, np.asarray(played.root)[:, :2])
    return Measures(distance[:, None], np.array(["error"]), np.array(["m"]))
