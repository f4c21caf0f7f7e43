"""Whether a directed motion does what was asked of it."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.path_frames import arc_length
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.motion import Animation, MotionPath


@node(over="dataset")
def path(path: MotionPath, animation: Animation) -> Measures:
    """How far the way and the duration of a motion are from what was asked, one row, entries as follows.

    `distance` m, `duration` s: the larger of |promised - asked| and |measured - asked|; `promised distance`,
    `measured distance`, `displacement` m and `measured duration` s. Promised is what the path says of itself;
    measured is read off the vertices (frame, vertex, 3) that came out: the arc length of the mean vertex's track on
    the ground, frames / fps. nan where nothing was asked.

    Raises ValueError where path and animation differ in frames.
    Source: 000 section 6.2 (errors against targets of distance and time).
    Departure: absolute errors, both promised and re-measured; 000 gives the relative error of what is promised.
    """
    mesh = animation.mesh
    if len(mesh.vertices) != len(path.provenance.take):
        raise ValueError(
            f"evaluate.path: the animation must play the path, {len(path.provenance.take)} frames, got "
            f"{len(mesh.vertices)}: wire an animation of this path"
        )
    track = np.asarray(mesh.vertices, np.float64)[:, :, [0, 2]].mean(axis=1)
    way, time = arc_length(track), len(track) / float(mesh.fps)
    promised, asked = (float(number) for number in path.distance)
    promised_time, asked_time = (float(number) for number in path.duration)
    values = {
        "distance": (max(abs(promised - asked), abs(way - asked)), "m"),
        "duration": (max(abs(promised_time - asked_time), abs(time - asked_time)), "s"),
        "promised distance": (promised, "m"),
        "measured distance": (way, "m"),
        "displacement": (float(np.linalg.norm(track[-1] - track[0])), "m"),
        "measured duration": (time, "s"),
    }
    return Measures(
        np.array([[value for value, _ in values.values()]]),
        np.array(list(values)),
        np.array([unit for _, unit in values.values()]),
    )
