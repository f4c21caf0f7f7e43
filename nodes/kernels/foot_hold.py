"""Holding planted feet still: the mesh follows, over time and up the leg."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import dijkstra

from reperform.nodes.kernels.foot_contacts import surface_lengths
from reperform.nodes.kernels.laplacian import factorise, vertex_adjacency

# Distance along the surface from the sole, as shares of the body's height, within which the foot moves as one,
# and beyond which nothing moves: ankle and hip.
_RIGID, _REACH = 0.13, 0.45
# Length over which the field is smoothed, so that it has no kinks, as a share of the body's height.
_SMOOTH = 0.02


class Contact(NamedTuple):
    """Frames first .. last in which one foot rests."""

    foot: int
    first: int
    last: int


def contacts(planted: np.ndarray) -> list[Contact]:
    """The contact intervals of planted (T, K), foot by foot in order of time."""
    found = []
    for k in range(planted.shape[1]):
        change = np.diff(np.concatenate([[False], planted[:, k], [False]]).astype(np.int8))
        ends = zip(np.flatnonzero(change == 1), np.flatnonzero(change == -1), strict=True)
        found += [Contact(k, int(first), int(end) - 1) for first, end in ends]
    return found


def leg_fields(vertices: np.ndarray, faces: np.ndarray, foot: np.ndarray) -> np.ndarray:
    """How much each vertex follows each foot, (K, V) in 0 .. 1: 1 on the foot, falling smoothly to 0 at the hip.

    vertices: (V, 3) of any frame, m; foot: (V,) as foot_contacts tells. Computed once per topology.
    """
    height = float(np.ptp(vertices[:, 1]))
    lengths = surface_lengths(vertices, faces)
    n = len(vertices)
    adjacency = vertex_adjacency(faces, n)
    degree = scipy.sparse.diags(np.asarray(adjacency.sum(axis=1)).ravel())
    # a graph Laplacian of even triangles of edge h is -1.5 h^2 times the surface's
    strength = (_SMOOTH * height / float(lengths.data.mean())) ** 2 / 1.5
    smooth = factorise(scipy.sparse.eye(n) + strength * (degree - adjacency))
    out = np.zeros((int(foot.max()) + 1, n))
    for k in range(len(out)):
        far = dijkstra(lengths, indices=np.flatnonzero(foot == k), min_only=True, limit=_REACH * height)
        u = np.clip((_REACH - np.minimum(far / height, _REACH)) / (_REACH - _RIGID), 0.0, 1.0)
        field = smooth.solve(u * u * (3.0 - 2.0 * u))
        out[k] = np.clip(field / field[foot == k].min(), 0.0, 1.0)
        out[k][out[k] < 1e-3] = 0.0
    return out


def hold_feet(
    vertices: np.ndarray,
    foot: np.ndarray,
    planted: np.ndarray,
    fields: np.ndarray,
    fps: float,
    ease: float = 0.12,
) -> np.ndarray:
    """The motion (T, V, 3), m, with every planted foot standing still; the dtype is kept.

    foot (V,), planted (T, K): as foot_contacts tells; fields (K, V): as leg_fields.

        x_v(t) + sum_k w_kv d_k(t),   d_k(t) = c_i - p_k(t) in contact i of foot k,   p_k the mean of its sole

    Elsewhere d_k, and every resting place c_i, minimise sum_t |d''|^2 + ease^-4 |d|^2: velocity stays
    continuous, and the correction dies out over about `ease` seconds.

    Source: Kovar, Schreiner and Gleicher 2002, SCA (footskate clean-up: one place per contact, eased corrections).
    Departure: on the surface by a field instead of by leg joints; places and easing from one quadratic problem.
    """
    out = vertices.astype(np.float64)
    for k in range(planted.shape[1]):
        if planted[:, k].any():
            sole = vertices[:, foot == k].mean(axis=1, dtype=np.float64)
            shift = hold_points(sole, planted[:, k], fps, ease)
            moved = np.flatnonzero(fields[k])
            out[:, moved] += fields[k][moved, None] * shift[:, None]
    return out.astype(vertices.dtype)


def hold_points(points: np.ndarray, planted: np.ndarray, fps: float, ease: float = 0.12) -> np.ndarray:
    """The smoothest shift (T, D) that keeps a point (T, D) at one place in every contact of planted (T,)."""
    count = len(points)
    spans = contacts(planted[:, None])
    if not spans:
        return np.zeros_like(points, np.float64)
    free = np.flatnonzero(~planted)
    # d = select @ unknowns - known: the unknowns are d where the foot is free, then one place per contact
    rows = np.concatenate([free, *(np.arange(c.first, c.last + 1) for c in spans)])
    columns = np.concatenate(
        [np.arange(len(free)), *(np.full(c.last - c.first + 1, len(free) + i) for i, c in enumerate(spans))]
    )
    select = scipy.sparse.csr_matrix((np.ones(count), (rows, columns)), shape=(count, len(free) + len(spans)))
    known = np.where(planted[:, None], points, 0.0)
    bend = scipy.sparse.diags([1.0, -2.0, 1.0], [0, 1, 2], shape=(max(count - 2, 0), count))
    stiff = bend.T @ bend + (ease * fps) ** -4.0 * scipy.sparse.eye(count)
    unknown = factorise(select.T @ stiff @ select).solve(select.T @ (stiff @ known))
    return np.asarray(select @ unknown - known)
