"""Whether poses were shown when they were asked for."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.pose_walk import PoseWalk


@node(over="dataset")
def timed_poses(walk: PoseWalk) -> Measures:
    """How many frames early or late each asked pose is shown, and whether it is shown as captured.

    One row per asked pose: `time error`, |shown - asked| in frames; `blended`, the weight of another source in the
    frame that shows it and the distance of its moment from a captured one, which should be 0.

    Raises ValueError where no pose was asked for at a time.
    Source: 002 section 4 (Boukhayma and Boyer 2015, 3DV, pose/time constraints), which shows pictures only.
    """
    asked, shown = np.asarray(walk.asked), np.asarray(walk.shown)
    if not len(asked) or not np.isfinite(asked).all():
        raise ValueError(
            "evaluate.timed_poses: the walk was asked no times: wire one of synthesis.timed_poses"
        )
    weight, time = np.asarray(walk.weight)[shown], np.asarray(walk.time)[shown]
    heavier = weight.argmax(axis=1)
    moment = time[np.arange(len(heavier)), heavier]
    blended = weight.min(axis=1) + np.abs(moment - np.rint(moment))
    return Measures(
        np.column_stack([np.abs(shown - asked), blended]),
        np.array(["time error", "blended"]),
        np.array(["frame", "1"]),
    )
