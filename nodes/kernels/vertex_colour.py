"""A colour for every vertex of a captured mesh, also where no camera looks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse

from reperform.nodes.kernels.laplacian import vertex_adjacency
from reperform.nodes.kernels.source_view import SourceView
from reperform.nodes.kernels.view_dependent import view_dependent_colour


def vertex_colour(
    vertices: np.ndarray,
    faces: np.ndarray,
    normals: np.ndarray,
    views: Sequence[SourceView],
    *,
    bias: float = 0.01,
    gains: np.ndarray | None = None,
    passes: int = 40,
) -> np.ndarray:
    """Colours (V, 3) float32, 0..255: what the cameras show, spread along the surface to what they do not.

    With r the reliability (saturating at 0.2) and A the mean over neighbours, `passes` times:
    colour <- r seen + (1 - r) A colour, over neighbours that have a colour. Vertices never reached (pieces
    that no camera sees) take the mean colour of the rest, mid-grey where there is none.
    """
    seen, reliability = view_dependent_colour(vertices, normals, None, views, bias=bias, gains=gains)
    keep = np.clip(reliability / 0.2, 0, 1)[:, None].astype(np.float64)
    neighbours = scipy.sparse.csr_matrix(vertex_adjacency(faces, len(vertices)), dtype=np.float64)
    colour = seen.astype(np.float64) * (keep > 0)
    known = (keep[:, 0] > 0).astype(np.float64)
    for _ in range(passes):
        weight = neighbours @ known
        spread = (neighbours @ (colour * known[:, None])) / np.maximum(weight, 1e-12)[:, None]
        reached = weight > 0
        mix = np.where(reached[:, None], keep * seen + (1 - keep) * spread, colour)
        colour = mix
        known = np.maximum(known, reached)
        if known.all() and (keep >= 1).all():
            break
    unknown = known == 0
    colour[unknown] = colour[~unknown].mean(axis=0) if (~unknown).any() else 128.0
    return colour.astype(np.float32)
