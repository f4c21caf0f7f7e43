"""Silhouettes of meshes, and how well two agree."""

from __future__ import annotations

import numpy as np

from reperform.nodes.kernels.camera import project
from reperform.nodes.kernels.rasterise import rasterise


def silhouette(
    vertices: np.ndarray,
    faces: np.ndarray,
    matrix: np.ndarray,
    rotation: np.ndarray,
    translation: np.ndarray,
    distortion: np.ndarray | None,
    height: int,
    width: int,
) -> np.ndarray:
    """Pixels (y, x) bool whose centre a mesh covers in one camera; vertices go through the lens model."""
    pixels, depth = project(vertices, matrix, rotation, translation, distortion)
    return rasterise(pixels, depth, faces, height, width)[0] >= 0


def intersection_over_union(first: np.ndarray, second: np.ndarray) -> float:
    """Common over joint area of two masks; 1 where both are empty."""
    union = np.count_nonzero(first | second)
    return np.count_nonzero(first & second) / union if union else 1.0
