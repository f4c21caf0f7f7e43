"""Whether feet skate."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.played import Played


@node(over="take")
def skating(played: Played) -> Measures:
    """Ground speed of every foot while it is planted, m/s: one row per frame, entries `foot 0`, `foot 1`, ..

    A foot is planted where what is blended has it planted (19 of 20 parts), in this frame and the one before; nan
    elsewhere. The foot is the middle of its sole on the mesh that is shown.

    Source: definition. The seeds report skating in words only (000 section 7).
    """
    soles, planted = np.asarray(played.soles), np.asarray(played.planted)
    speed = np.full(planted.shape, np.nan)
    step = np.linalg.norm(np.diff(soles[..., [0, 2]], axis=0), axis=-1) * float(np.asarray(played.mesh.fps))
    speed[1:] = np.where(planted[1:] & planted[:-1], step, np.nan)
    feet = planted.shape[1]
    return Measures(speed, np.array([f"foot {k}" for k in range(feet)]), np.array(["m/s"] * feet))
