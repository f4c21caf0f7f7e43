"""Texture coordinates for any mesh: charts that face one of six directions, projected and packed."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import distance_transform_edt
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from reperform.nodes.kernels.mesh_geometry import face_normals
from reperform.nodes.kernels.rasterise import rasterise

DIRECTIONS = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
# the two axes of the picture for each direction: seen from outside, not mirrored
ACROSS = np.array([[0, 0, -1], [0, 0, 1], [1, 0, 0], [1, 0, 0], [1, 0, 0], [-1, 0, 0]], float)
ABOVE = np.array([[0, 1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1], [0, 1, 0], [0, 1, 0]], float)
PADDING = 2


def chart_atlas(
    vertices: np.ndarray,
    faces: np.ndarray,
    size: int,
    density: np.ndarray | None = None,
    regions: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """uv (N, 2) float32 and faces_uv (F, 3) int32 of a square picture of `size` texels.

    Each face is seen from the coordinate direction nearest its normal; connected faces of one direction are a
    chart, drawn orthographically (stretch at most 1.73) and packed in rows. density (F,): relative resolution
    wanted by each face, averaged over its chart. regions (F,) int: charts do not cross from one to another.
    """
    density = np.ones(len(faces)) if density is None else density
    labels = _directions(vertices, faces)
    charts = _charts(faces, labels if regions is None else labels + 6 * regions)
    uv, faces_uv = _lay_out(vertices, faces, labels, charts, density, size)
    hidden = _overlapped(uv, faces_uv, size)
    if hidden.any():
        charts[hidden] = charts.max() + 1 + np.arange(hidden.sum())
        uv, faces_uv = _lay_out(vertices, faces, labels, charts, density, size)
    return uv, faces_uv


def texel_hits(
    uv: np.ndarray, faces_uv: np.ndarray, height: int, width: int
) -> tuple[np.ndarray, np.ndarray]:
    """Which face each texel of the picture shows, ids (H, W) with -1 = none, and where, barycentric (H, W,
    3).
    """
    pixels = np.column_stack([uv[:, 0] * width - 0.5, (1 - uv[:, 1]) * height - 0.5])
    ids, barycentric, _ = rasterise(pixels, np.ones(len(uv)), faces_uv, height, width)
    return ids, barycentric


def fill_gutters(image: np.ndarray, painted: np.ndarray) -> np.ndarray:
    """Every unpainted texel takes the colour of the nearest painted one, so that no seam shows."""
    rows, columns = distance_transform_edt(~painted, return_distances=False, return_indices=True)
    return image[rows, columns]


def _neighbours(faces: np.ndarray) -> np.ndarray:
    """Pairs of faces (E, 2) that share an edge."""
    edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(faces)), 3)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    edges, owner = edges[order], owner[order]
    same = np.flatnonzero((edges[1:] == edges[:-1]).all(axis=1))
    return np.column_stack([owner[same], owner[same + 1]])


def _directions(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Label of each face: the nearest direction, smoothed so that charts have few ragged islands."""
    facing = face_normals(vertices, faces).astype(float) @ DIRECTIONS.T
    pairs = _neighbours(faces)
    matrix = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(faces),) * 2).tocsr()
    matrix = matrix + matrix.T
    labels = facing.argmax(1)
    for _ in range(8):
        votes = matrix @ np.eye(6)[labels]
        labels = np.where(facing > 0.25, facing + 0.45 * votes, -1 + facing).argmax(1)
    return labels


def _charts(faces: np.ndarray, labels: np.ndarray) -> np.ndarray:
    pairs = _neighbours(faces)
    pairs = pairs[labels[pairs[:, 0]] == labels[pairs[:, 1]]]
    matrix = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(faces),) * 2)
    return connected_components(matrix, directed=False)[1].astype(np.int64)


def _lay_out(
    vertices: np.ndarray,
    faces: np.ndarray,
    labels: np.ndarray,
    charts: np.ndarray,
    density: np.ndarray,
    size: int,
) -> tuple[np.ndarray, np.ndarray]:
    corners = vertices[faces].astype(float)
    flat = np.stack(
        [np.einsum("fki,fi->fk", corners, ACROSS[labels]), np.einsum("fki,fi->fk", corners, ABOVE[labels])],
        axis=-1,
    )
    _, charts = np.unique(charts, return_inverse=True)
    count = charts.max() + 1
    wanted = np.bincount(charts, density, count) / np.bincount(charts, minlength=count)
    flat *= wanted[charts][:, None, None]
    flat = _upright(flat, charts, count)
    lower = np.full((count, 2), np.inf)
    upper = np.full((count, 2), -np.inf)
    np.minimum.at(lower, charts, flat.min(1))
    np.maximum.at(upper, charts, flat.max(1))
    extent = upper - lower
    scale, corner = _pack(extent, size)
    place = (flat - lower[charts][:, None]) * scale + corner[charts][:, None] + PADDING
    # one uv per (chart, vertex): charts of one direction share uv inside, never across
    keys = np.column_stack([np.repeat(charts, 3), faces.reshape(-1)])
    _, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    uv = place.reshape(-1, 2)[first] / size
    return uv.astype(np.float32), inverse.reshape(-1, 3).astype(np.int32)


def _upright(flat: np.ndarray, charts: np.ndarray, count: int) -> np.ndarray:
    """Each chart's corners (F, 3, 2) turned by the angle, of 18, at which its box is smallest, and wider than tall."""
    angles = np.pi * np.arange(18) / 36
    best, angle = np.full(count, np.inf), np.zeros(count)
    for candidate in angles:
        turn = np.array([[np.cos(candidate), np.sin(candidate)], [-np.sin(candidate), np.cos(candidate)]])
        turned = flat @ turn
        lower, upper = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
        np.minimum.at(lower, charts, turned.min(axis=1))
        np.maximum.at(upper, charts, turned.max(axis=1))
        wide, tall = (upper - lower).T
        smaller = wide * tall < best * (1 - 1e-9)
        best[smaller] = (wide * tall)[smaller]
        angle[smaller] = np.where(tall > wide, candidate + np.pi / 2, candidate)[smaller]
    cos, sin = np.cos(angle)[charts][:, None], np.sin(angle)[charts][:, None]
    x, y = flat[..., 0], flat[..., 1]
    return np.stack([x * cos - y * sin, x * sin + y * cos], axis=-1)


def _pack(extent: np.ndarray, size: int) -> tuple[float, np.ndarray]:
    """The largest scale (texels per metre) at which all boxes fit in rows, and their corners (texels)."""
    low, high = 0.0, size / max(float(extent.max()), 1e-9)
    best = np.zeros_like(extent)
    for _ in range(24):
        middle = 0.5 * (low + high)
        corner = _shelves(extent * middle, size)
        if corner is None:
            high = middle
        else:
            low, best = middle, corner
    return low, best


def _shelves(extent: np.ndarray, size: int) -> np.ndarray | None:
    boxes = np.ceil(extent) + 2 * PADDING
    corner = np.zeros_like(boxes)
    x = y = shelf = 0.0
    for chart in np.lexsort((boxes[:, 0], -boxes[:, 1])):
        wide, tall = boxes[chart]
        if x + wide > size:
            x, y, shelf = 0.0, y + shelf, 0.0
        if wide > size or y + tall > size:
            return None
        corner[chart] = x, y
        x, shelf = x + wide, max(shelf, tall)
    return corner


def _overlapped(uv: np.ndarray, faces_uv: np.ndarray, size: int) -> np.ndarray:
    """Faces of which other faces of the same chart hide a good part."""
    ids, _ = texel_hits(uv, faces_uv, size, size)
    owned = np.bincount(ids[ids >= 0], minlength=len(faces_uv))
    a, b, c = (uv[faces_uv[:, k]].astype(float) * size for k in range(3))
    area = 0.5 * np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    return owned + 3 * np.sqrt(area) + 2 < area
