"""Whether feet skate."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.foot_contacts import foot_contacts
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.played import Played


@node(over="take")
def skating(played: Played) -> Measures:
    """Ground speed of every foot while it is planted, m/s: one row per frame, entries `foot 0`, `foot 1`, ..

    A foot is planted where what is blended has it planted (19 of 20 parts), in this frame and the one before; nan
    elsewhere. The foot is the middle of its sole on the mesh that is shown, the sole told from that mesh alone.

    Raises ValueError where the mesh has not as many feet as the motion.
    Source: definition. The seeds report skating in words only (000 section 7).
    """
    vertices, planted = np.asarray(played.mesh.vertices), np.asarray(played.planted)
    fps, feet = float(np.asarray(played.mesh.fps)), planted.shape[1]
    foot = foot_contacts([vertices], np.asarray(played.mesh.faces), fps).foot
    if int(foot.max()) + 1 != feet:
        raise ValueError(
            f"evaluate.skating: the motion has {feet} feet, the mesh rests on {int(foot.max()) + 1}: play for longer, so "
            "that every foot rests"
        )
    speed = np.full(planted.shape, np.nan)
    for k in range(feet):
        sole = vertices[:, foot == k][..., [0, 2]].mean(axis=1, dtype=np.float64)
        step = np.linalg.norm(np.diff(sole, axis=0), axis=-1) * fps
        speed[1:, k] = np.where(planted[1:, k] & planted[:-1, k], step, np.nan)
    return Measures(speed, np.array([f"foot {k}" for k in range(feet)]), np.array(["m/s"] * feet))
