"""The virtual actor, built once per costume: surface, skinning weights, atlas and loose garment, in the
rest pose.
"""

from __future__ import annotations

import threading
from functools import lru_cache
from typing import NamedTuple

import fast_simplification
import numpy as np

from reperform.nodes.kernels.chart_atlas import chart_atlas, fill_gutters, texel_hits
from reperform.nodes.kernels.implicit_body import (
    Part,
    distance_grid,
    isosurface,
    nearest_part,
    part_coordinates,
)
from reperform.nodes.kernels.laplacian import vertex_adjacency
from reperform.nodes.kernels.mesh_geometry import vertex_normals
from reperform.nodes.kernels.rasterise import interpolate
from reperform.nodes.studio.actor_paint import Rgb, colours
from reperform.nodes.studio.actor_parts import Costume, costume_parts
from reperform.nodes.studio.actor_skeleton import BONE

VOXEL = 0.007
FACES = 11000
ATLAS = 1024
LOWER = np.array([-0.68, -0.02, -0.40])
UPPER = np.array([0.68, 1.80, 0.40])
# a vertex belongs to every part nearly as near as the nearest one
SHARING = 0.012
SMOOTHING = 6
THIGH_SHARE = 0.62

_SKIN: tuple[Rgb, ...] = (
    (0.86, 0.66, 0.54), (0.86, 0.50, 0.42), (0.62, 0.40, 0.31), (0.72, 0.29, 0.28), (0.20, 0.13, 0.09), (0.32, 0.22, 0.12),
)  # fmt: skip
_DARK_SKIN: tuple[Rgb, ...] = (
    (0.55, 0.37, 0.27), (0.58, 0.33, 0.24), (0.36, 0.22, 0.16), (0.50, 0.23, 0.21), (0.07, 0.05, 0.05), (0.18, 0.11, 0.07),
)  # fmt: skip
_PALE_SKIN: tuple[Rgb, ...] = (
    (0.88, 0.70, 0.58),
    (0.86, 0.58, 0.48),
    (0.64, 0.43, 0.34),
    (0.74, 0.46, 0.40),
    (0.34, 0.22, 0.12),
    (0.25, 0.34, 0.40),
)
_PALETTES: dict[str, dict[str, tuple[Rgb, ...]]] = {
    "skirt": {
        "skin": _SKIN, "hair": ((0.16, 0.09, 0.05), (0.45, 0.27, 0.14)),
        "top": ((0.90, 0.84, 0.70), (0.70, 0.20, 0.13), (0.22, 0.30, 0.20), (0.62, 0.18, 0.12)),
        "skirt": ((0.66, 0.12, 0.12), (0.10, 0.20, 0.12), (0.93, 0.78, 0.28), (0.95, 0.93, 0.88)),
        "tights": ((0.22, 0.17, 0.17), (0.38, 0.28, 0.26)),
        "shoe": ((0.42, 0.24, 0.12), (0.28, 0.15, 0.07), (0.10, 0.08, 0.07), (0.80, 0.66, 0.44)),
    },
    "dress": {
        "skin": _DARK_SKIN, "hair": ((0.05, 0.04, 0.04), (0.18, 0.13, 0.11)),
        "bodice": ((0.55, 0.10, 0.18), (0.36, 0.05, 0.12), (0.96, 0.80, 0.72), (0.93, 0.72, 0.20),
                (0.94, 0.52, 0.28), (0.55, 0.37, 0.27)),
        "skirt": ((0.55, 0.10, 0.18), (0.36, 0.05, 0.12), (0.96, 0.80, 0.72), (0.93, 0.72, 0.20), (0.94, 0.52, 0.28)),
        "shoe": ((0.80, 0.62, 0.34), (0.66, 0.48, 0.25), (0.25, 0.18, 0.12), (0.95, 0.86, 0.60)),
    },
    "jacket": {
        "skin": _PALE_SKIN, "hair": ((0.33, 0.20, 0.09), (0.62, 0.43, 0.22)),
        "coat": ((0.50, 0.38, 0.24), (0.34, 0.25, 0.15), (0.24, 0.16, 0.10), (0.93, 0.91, 0.87),
                (0.45, 0.22, 0.10), (0.72, 0.25, 0.22), (0.36, 0.35, 0.34)),
        "trousers": ((0.36, 0.35, 0.34), (0.25, 0.24, 0.24), (0.78, 0.72, 0.60)),
        "shoe": ((0.24, 0.13, 0.08), (0.16, 0.08, 0.05), (0.07, 0.06, 0.06), (0.70, 0.62, 0.50)),
    },
}  # fmt: skip


class Actor(NamedTuple):
    """Rest pose at the reference stature: vertices (V, 3), faces (F, 3), weights (V, B), atlas, garment
    place.

    garment (V, 2): t along the loose garment and turns round it; t = nan where the vertex is not on it.
    """

    vertices: np.ndarray
    faces: np.ndarray
    weights: np.ndarray
    uv: np.ndarray
    faces_uv: np.ndarray
    image: np.ndarray
    garment: np.ndarray
    skirt: Part


_LOCK = threading.Lock()


def build_actor(costume: Costume) -> Actor:
    """The actor in a costume. Built once per process; about three seconds."""
    with _LOCK:
        return _build(costume)


@lru_cache(maxsize=3)
def _build(costume: Costume) -> Actor:
    parts = costume_parts(costume)
    grid = distance_grid(parts, LOWER, UPPER, VOXEL)
    dense, dense_faces = isosurface(grid, LOWER, VOXEL)
    vertices, faces = fast_simplification.simplify(dense, dense_faces, target_count=FACES, agg=3)
    vertices, faces = vertices.astype(np.float32), faces.astype(np.int32)
    owner, distances = nearest_part(vertices, parts)
    skirt_index = next(index for index, part in enumerate(parts) if part.name == "skirt")
    weights = _weights(vertices, faces, parts, distances)
    garment = np.full((len(vertices), 2), np.nan)
    rows = np.flatnonzero(owner == skirt_index)
    garment[rows] = garment_place(vertices[rows], parts[skirt_index])
    head = (
        1
        + 0.9 * weights[:, BONE["head"]]
        + 0.4 * (weights[:, BONE["left_hand"]] + weights[:, BONE["right_hand"]])
    )
    uv, faces_uv = chart_atlas(
        vertices, faces, ATLAS, head[faces].mean(axis=1), weights[faces].sum(axis=1).argmax(axis=1)
    )
    image = _paint(vertices, faces, uv, faces_uv, parts, costume)
    return Actor(vertices, faces, weights, uv, faces_uv, image, garment, parts[skirt_index])


def garment_place(points: np.ndarray, skirt: Part) -> np.ndarray:
    """(t along the garment clipped to [0, 1], turns round it in [0, 1)) of rest points."""
    t, u, w = part_coordinates(points.astype(float), skirt)
    return np.column_stack([np.clip(t, 0, 1), (np.arctan2(u, w) / (2 * np.pi)) % 1.0])


def part_weights(points: np.ndarray, part: Part) -> np.ndarray:
    """Weights (N, B) of points on one part: linear between its knots; a garment is shared by hips and
    thighs.
    """
    weights = np.zeros((len(points), len(BONE)))
    bones = [BONE[bone] for bone in part.bones]
    if len(bones) == 1:
        weights[:, bones[0]] = 1
        return weights
    t, _, _ = part_coordinates(points.astype(float), part)
    if part.looseness:
        thigh = THIGH_SHARE * np.interp(t, (0.05, 0.55, 1.0), (0.0, 0.75, 1.0))
        left = np.clip(0.5 + points[:, 0] / 0.30, 0, 1)
        left = left * left * (3 - 2 * left)
        weights[:, bones[0]] = 1 - thigh
        weights[:, bones[1]], weights[:, bones[2]] = thigh * left, thigh * (1 - left)
        return weights
    for column, bone in enumerate(bones):
        weights[:, bone] = np.interp(t, part.knots, np.eye(len(bones))[column])
    return weights


def _weights(
    vertices: np.ndarray, faces: np.ndarray, parts: tuple[Part, ...], distances: np.ndarray
) -> np.ndarray:
    nearness = np.exp(-(distances - distances.min(axis=1, keepdims=True)) / SHARING)
    nearness /= nearness.sum(axis=1, keepdims=True)
    weights = np.zeros((len(vertices), len(BONE)))
    for column, part in enumerate(parts):
        rows = np.flatnonzero(nearness[:, column] > 1e-3)
        weights[rows] += nearness[rows, column, None] * part_weights(vertices[rows], part)
    ring = vertex_adjacency(faces, len(vertices)).astype(float)
    degree = np.asarray(ring.sum(axis=1)).reshape(-1, 1)
    for _ in range(SMOOTHING):
        weights = 0.5 * weights + 0.5 * (ring @ weights) / degree
    weights[weights < 1e-3] = 0
    return (weights / weights.sum(axis=1, keepdims=True)).astype(np.float32)


def _paint(
    vertices: np.ndarray, faces: np.ndarray, uv: np.ndarray, faces_uv: np.ndarray, parts: tuple[Part, ...],
    costume: Costume,
) -> np.ndarray:  # fmt: skip
    ids, barycentric = texel_hits(uv, faces_uv, ATLAS, ATLAS)
    painted = ids >= 0
    points = interpolate(vertices, faces, ids[painted], barycentric[painted])
    owner, _ = nearest_part(points, parts)
    shade = interpolate(_openness(vertices, faces, parts)[:, None], faces, ids[painted], barycentric[painted])
    image = np.zeros((ATLAS, ATLAS, 3), np.uint8)
    image[painted] = np.rint(255 * colours(points, owner, parts, _PALETTES[costume]) * shade)
    return fill_gutters(image, painted)


def _openness(vertices: np.ndarray, faces: np.ndarray, parts: tuple[Part, ...]) -> np.ndarray:
    """1 on open surfaces, down to 0.62 in creases: distances off the surface compared with the steps taken."""
    normals = vertex_normals(vertices, faces)
    blocked = np.zeros(len(vertices))
    for step, share in ((0.018, 0.45), (0.05, 0.55)):
        _, distances = nearest_part(vertices + step * normals, parts)
        blocked += share * np.clip(1 - distances.min(axis=1) / step, 0, 1)
    return np.clip(1 - 0.6 * blocked, 0.62, 1).astype(np.float32)
