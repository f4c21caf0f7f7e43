"""Blends of several poses at many weights, what they have in common taken apart once."""

from __future__ import annotations

import numpy as np

from reperform.nodes.kernels.mesh_blend import MeshBlender, PosePair


class ReadyBlends:
    """Non-linear blends of N poses (V, 3) of one topology; poses of weight 0 have no say."""

    def __init__(self, blender: MeshBlender, poses: list[np.ndarray]) -> None:
        self._blender, self._poses = blender, poses
        self._pairs: dict[tuple[int, int], PosePair] = {}

    def at(self, weights: np.ndarray) -> np.ndarray:
        """The blend (V, 3) at weights (N,) >= 0 of sum 1."""
        used = np.flatnonzero(weights > 0).tolist()
        mesh, total = self._poses[used[0]], float(weights[used[0]])
        for k in used[1:]:
            total += float(weights[k])
            mesh = self._blender.at(self._pair(mesh, used[0], k, len(used)), float(weights[k]) / total)
        return mesh

    def _pair(self, mesh: np.ndarray, first: int, second: int, count: int) -> PosePair:
        if count > 2:
            return self._blender.pair(mesh, self._poses[second])
        if (first, second) not in self._pairs:
            self._pairs[first, second] = self._blender.pair(mesh, self._poses[second])
        return self._pairs[first, second]
