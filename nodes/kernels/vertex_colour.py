"""A colour for every vertex of a captured mesh, also where no camera looks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numba import njit

from reperform.nodes.kernels.source_view import SourceView
from reperform.nodes.kernels.view_dependent import view_dependent_colour


def vertex_colour(
    vertices: np.ndarray,
    faces: np.ndarray,
    normals: np.ndarray,
    views: Sequence[SourceView],
    *,
    bias: float = 0.003,
    gains: np.ndarray | None = None,
    passes: int = 15,
) -> np.ndarray:
    """Colours (V, 3) float32, 0..255: what the cameras show, spread along the surface to what they do not.

    With r the reliability (clipped to 0.05 .. 0.25 and scaled to 0 .. 1) and A the mean over neighbours,
    `passes` times: colour <- r seen + (1 - r) A colour, over neighbours that have a colour. Vertices never
    reached (pieces that no camera sees) take the mean colour of the rest, mid-grey where there is none.
    """
    seen, reliability = view_dependent_colour(vertices, normals, None, views, bias=bias, gains=gains)
    keep = np.clip((reliability - 0.05) / 0.2, 0, 1).astype(np.float64)
    colour, known = _spread(seen.astype(np.float64), keep, np.ascontiguousarray(faces, np.int32), passes)
    colour[~known] = colour[known].mean(axis=0) if known.any() else 128.0
    return colour.astype(np.float32)


@njit(cache=True, nogil=True)
def _spread(
    seen: np.ndarray, keep: np.ndarray, faces: np.ndarray, passes: int
) -> tuple[np.ndarray, np.ndarray]:
    """Colours (V, 3), and which vertices (V,) have one."""
    count = len(seen)
    colour, known = seen.copy(), keep > 0
    total, number = np.zeros((count, 3)), np.zeros(count)
    for _ in range(passes):
        total[:], number[:] = 0.0, 0.0
        for f in range(len(faces)):
            for corner in range(3):
                to = faces[f, corner]
                if keep[to] >= 1:
                    continue
                for step in range(1, 3):
                    neighbour = faces[f, (corner + step) % 3]
                    if known[neighbour]:
                        number[to] += 1
                        for k in range(3):
                            total[to, k] += colour[neighbour, k]
        for v in range(count):
            if number[v] > 0:
                known[v] = True
                for k in range(3):
                    colour[v, k] = keep[v] * seen[v, k] + (1 - keep[v]) * total[v, k] / number[v]
    return colour, known
