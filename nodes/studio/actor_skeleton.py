"""The virtual actor's skeleton in its rest pose: arms 40 degrees from the body, legs a little apart, facing
+z.
"""

from __future__ import annotations

import numpy as np

REFERENCE_STATURE = 1.72
BALL_HEIGHT = 0.022
# the sole's last point of contact behind the ball of the foot
HEEL_BEHIND_BALL = 0.185

_CENTRE = (
    ("hips", "", (0.0, 0.95, 0.0)),
    ("spine", "hips", (0.0, 1.06, -0.004)),
    ("chest", "spine", (0.0, 1.21, -0.010)),
    ("neck", "chest", (0.0, 1.455, -0.018)),
    ("head", "neck", (0.0, 1.535, 0.000)),
)
_SIDE = (
    ("collar", "chest", (0.030, 1.400, -0.005)),
    ("arm", "collar", (0.168, 1.395, -0.012)),
    ("forearm", "arm", (0.343, 1.186, -0.012)),
    ("hand", "forearm", (0.502, 0.999, 0.006)),
    ("thigh", "hips", (0.088, 0.905, 0.0)),
    ("shin", "thigh", (0.105, 0.495, 0.008)),
    ("foot", "shin", (0.118, 0.088, -0.018)),
    ("toe", "foot", (0.128, BALL_HEIGHT, 0.105)),
)


def _build() -> tuple[tuple[str, ...], np.ndarray, np.ndarray]:
    rows: list[tuple[str, str, tuple[float, float, float]]] = list(_CENTRE)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        for name, parent, (x, y, z) in _SIDE:
            above = parent if parent in ("chest", "hips") else f"{side}_{parent}"
            rows.append((f"{side}_{name}", above, (sign * x, y, z)))
    names = tuple(name for name, _, _ in rows)
    parents = np.array([names.index(parent) if parent else -1 for _, parent, _ in rows], np.int32)
    return names, parents, np.array([place for _, _, place in rows])


NAMES, PARENTS, REST_JOINTS = _build()
BONE = {name: index for index, name in enumerate(NAMES)}
