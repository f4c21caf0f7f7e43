"""A skeleton's bones as faces of a mesh: triangles without area."""

from __future__ import annotations

import numpy as np


def bone_faces(parents: np.ndarray) -> np.ndarray:
    """(bones, 3): parent, joint, joint; one hierarchy is one topology."""
    joints = np.flatnonzero(np.asarray(parents) >= 0)
    return np.stack([np.asarray(parents)[joints], joints, joints], axis=1).astype(np.int32)
