"""Which parts of a moving surface rest on the ground, and when, told from meshes of one topology alone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import scipy.sparse
from scipy.ndimage import binary_closing, binary_opening
from scipy.sparse.csgraph import connected_components, dijkstra

from reperform.nodes.kernels.mesh_geometry import edges

# Heel and ball of one foot are joined over the surface by less than this, two feet by more; m.
_ONE_FOOT = 0.35
# The part of a foot that counts rests at least this share of the time that its most rested vertex does.
_RESTS = 0.85
# The surface between these distances from the sole is the ankle; m.
_ANKLE = (0.1, 0.22)
# Components of fewer vertices than this share of the largest are noise.
_SMALL = 0.1
# Contacts and gaps between them are at least this long; s.
_SHORT = 0.07


class FootContacts(NamedTuple):
    """Feet as vertex sets, and which of them rest when.

    foot (V,) int8: k of the sole vertices of foot k, -1 elsewhere; planted: per take (T, K) bool.
    Two feet come as left, right.
    """

    foot: np.ndarray
    planted: list[np.ndarray]


def foot_contacts(
    takes: Sequence[np.ndarray], faces: np.ndarray, fps: float, height: float = 0.04, speed: float = 0.25
) -> FootContacts:
    """Find the soles and their contacts in all takes (T, V, 3), m, y up, of one topology.

    A vertex rests where it is within `height` (m) of the ground and slower than `speed` (m/s); the ground is
    the tenth percentile of the lowest vertices of all frames. Vertices that ever rest fall into feet by their
    distance along the surface; of each foot the sole is what rests longest (the ball, where a foot rolls). A
    foot is planted where its sole as a whole rests. Feet are none where nothing ever rests.

    Raises ValueError where takes are not (T, V, 3) of one V.
    Source: Kovar, Schreiner and Gleicher 2002, SCA (footskate clean-up: contacts by height and speed).
    Departure: feet are found on the surface, without a skeleton.
    """
    if not takes or any(t.ndim != 3 or t.shape[1:] != (takes[0].shape[1], 3) for t in takes):
        raise ValueError(
            f"foot contacts: takes must be (T, V, 3) with one V, got {', '.join(str(t.shape) for t in takes)}"
        )
    ground = float(np.percentile(np.concatenate([t[..., 1].min(axis=1) for t in takes]), 10))
    count = np.zeros(takes[0].shape[1])
    for take in takes:
        low = take[..., 1] < ground + height
        near = np.flatnonzero(low.any(axis=0))
        count[near] += (low[:, near] & (_speeds(take[:, near], fps) < speed)).sum(axis=0)
    foot = _soles(count, takes[0][0], faces)
    planted = _planted(takes, foot, fps, height, speed)
    if foot.max() == 1 and not _left_first(foot, takes, planted, faces):
        foot = np.where(foot >= 0, 1 - foot, foot).astype(np.int8)
        planted = [rests[:, ::-1].copy() for rests in planted]
    return FootContacts(foot, planted)


def _speeds(points: np.ndarray, fps: float) -> np.ndarray:
    """Speeds (T, N), m/s, of points (T, N, 3): the lower of that before and that after, over about 1/25 s.

    The first and the last frame of a contact are at rest on one side only.
    """
    reach = max(1, round(fps / 25.0))
    if len(points) <= reach:
        return np.zeros(points.shape[:2])
    steps = np.linalg.norm(points[reach:].astype(np.float64) - points[:-reach], axis=2) * (fps / reach)
    ends = np.full((reach, points.shape[1]), np.inf)
    return np.minimum(np.concatenate([steps, ends]), np.concatenate([ends, steps]))


def _soles(count: np.ndarray, vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Per vertex the foot whose sole it belongs to, by how often vertices rest (V,)."""
    foot = np.full(len(vertices), -1, np.int8)
    rested = np.flatnonzero(count > 0)
    if len(rested) == 0:
        return foot
    lengths = surface_lengths(vertices, faces)
    parts, part = connected_components(lengths[rested][:, rested], directed=False)
    weight = np.bincount(part, count[rested], parts)
    kept = np.flatnonzero(weight > _SMALL * weight.max())
    near = np.eye(len(kept), dtype=bool)
    for a in range(len(kept)):
        far = dijkstra(lengths, indices=rested[part == kept[a]], min_only=True, limit=_ONE_FOOT)
        near[a] |= [np.isfinite(far[rested[part == b]]).any() for b in kept]
    _, group = connected_components(scipy.sparse.csr_matrix(near), directed=False)
    for k in range(group.max() + 1):
        mine = rested[np.isin(part, kept[group == k])]
        foot[mine[count[mine] >= _RESTS * np.percentile(count[mine], 95)]] = k
    return foot


def surface_lengths(vertices: np.ndarray, faces: np.ndarray) -> scipy.sparse.csr_matrix:
    """Symmetric matrix of the lengths of all edges, (V, V), m."""
    ends = edges(faces)
    ends = ends[ends[:, 0] != ends[:, 1]]
    length = np.linalg.norm(vertices[ends[:, 0]].astype(np.float64) - vertices[ends[:, 1]], axis=1) + 1e-9
    half = scipy.sparse.coo_matrix((length, (ends[:, 0], ends[:, 1])), shape=(len(vertices),) * 2).tocsr()
    return half + half.T


def _left_first(
    foot: np.ndarray, takes: Sequence[np.ndarray], planted: Sequence[np.ndarray], faces: np.ndarray
) -> bool:
    """Whether the first of two feet is the left: the ball of a resting foot lies before its ankle."""
    lengths = surface_lengths(takes[0][0], faces)
    vote = 0.0
    sole = [np.flatnonzero(foot == k) for k in range(2)]
    for k in range(2):
        far = dijkstra(lengths, indices=sole[k], min_only=True, limit=_ANKLE[1])
        ankle = np.flatnonzero(np.isfinite(far) & (far > _ANKLE[0]))
        for take, rests in zip(takes, planted, strict=True):
            shown = take[rests[:, k]]
            if len(shown) and len(ankle):
                here = shown[:, sole[k]].mean(axis=1)
                ahead = here - shown[:, ankle].mean(axis=1)
                apart = (here - shown[:, sole[1 - k]].mean(axis=1)) * (1 - 2 * k)
                vote += float(np.sign(ahead[:, 2] * apart[:, 0] - ahead[:, 0] * apart[:, 2]).sum())
    return vote >= 0.0


def _planted(
    takes: Sequence[np.ndarray], foot: np.ndarray, fps: float, height: float, speed: float
) -> list[np.ndarray]:
    """Per take (T, K): the mean of the sole is within `height` (m) of where it lies and slower than `speed`.

    Where it lies is the fifth percentile of its heights: each sole has a thickness of its own.
    """
    out = [np.zeros((len(take), int(foot.max()) + 1), bool) for take in takes]
    short = max(1, round(_SHORT * fps))
    line = np.ones(short, bool)
    for k in range(int(foot.max()) + 1):
        centres = [take[:, foot == k].mean(axis=1, keepdims=True, dtype=np.float64) for take in takes]
        top = float(np.percentile(np.concatenate([centre[:, 0, 1] for centre in centres]), 5)) + height
        for centre, planted in zip(centres, out, strict=True):
            rests = (centre[:, 0, 1] < top) & (_speeds(centre, fps)[:, 0] < speed)
            held = np.pad(rests, short, mode="edge")
            # a flicker is neither a contact nor a gap
            planted[:, k] = binary_opening(binary_closing(held, line), line)[short : len(held) - short]
    return out
