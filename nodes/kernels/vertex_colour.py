"""A colour for every vertex of a captured mesh, also where no camera looks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reperform.nodes.kernels.laplacian import vertex_adjacency
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
    # Rows whose colour can change; last column: whether a vertex has a colour yet.
    open_rows = np.flatnonzero(keep < 1)
    rows = vertex_adjacency(faces, len(vertices))[open_rows].astype(np.float64)
    state = np.concatenate([seen * (keep > 0)[:, None], (keep > 0)[:, None]], axis=1).astype(np.float64)
    own, fixed = keep[open_rows, None], seen[open_rows]
    for _ in range(passes):
        spread = rows @ np.concatenate([state[:, :3] * state[:, 3:], state[:, 3:]], axis=1)
        reached = spread[:, 3] > 0
        mean = spread[:, :3] / np.maximum(spread[:, 3:], 1.0)
        state[open_rows[reached], :3] = (own * fixed + (1 - own) * mean)[reached]
        state[open_rows[reached], 3] = 1
    known = state[:, 3] > 0
    state[~known, :3] = state[known, :3].mean(axis=0) if known.any() else 128.0
    return state[:, :3].astype(np.float32)
