"""Blends of several poses at many weights, with what they have in common taken apart once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reperform.nodes.kernels.mesh_blend import MeshBlender, PoseSet


class ReadyBlends:
    """Non-linear blends of N poses (V, 3) of one topology; poses of weight 0 have no say."""

    def __init__(self, blender: MeshBlender, poses: Sequence[np.ndarray]) -> None:
        self._blender, self._poses = blender, poses
        self._sets: dict[tuple[int, ...], PoseSet] = {}

    def at(self, weights: np.ndarray) -> np.ndarray:
        """The blend (V, 3) at weights (N,) >= 0 of sum 1; a pose of weight 1 as it is."""
        used = tuple(np.flatnonzero(weights > 0).tolist())
        if len(used) == 1:
            return self._poses[used[0]]
        if used not in self._sets:
            self._sets[used] = self._blender.poses([self._poses[k] for k in used])
        return self._blender.blend(self._sets[used], weights[list(used)])
