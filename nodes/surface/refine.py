"""The visual hull brought in to where the pictures agree."""

from __future__ import annotations

from typing import Annotated, NamedTuple

import cv2
import numpy as np
import scipy.sparse

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.belief_propagation import beliefs, neighbour_lists
from reperform.nodes.kernels.decimate import decimate
from reperform.nodes.kernels.diffusion import diffuse
from reperform.nodes.kernels.edge_split import split_long_edges
from reperform.nodes.kernels.laplacian import vertex_adjacency
from reperform.nodes.kernels.matte_volume import refuse_mismatch
from reperform.nodes.kernels.mesh_geometry import vertex_normals
from reperform.nodes.kernels.mesh_window import MeshWindow, Rig, mesh_windows, visible_views
from reperform.nodes.kernels.outline_fit import outline_offsets
from reperform.nodes.kernels.plane_sweep import sweep_cost
from reperform.nodes.kernels.taubin import taubin_smooth
from reperform.nodes.kernels.unfold import unfold
from reperform.nodes.kernels.voxel_carving import camera_rows
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.footage import Footage, Mattes
from reperform.nodes.products.mesh import Surfaces

# Cameras compared at each place.
_MOST_VIEWS = 3
# Least cosine between the surface's normal and the direction to a camera that is asked.
_LEAST_COSINE = 0.25
# A place counts as seen up to this far (m) behind the nearest surface: that is still the hull's, and too near.
_TOLERANCE = 0.03
# Half the samples less one along a patch's side.
_HALF = 2
# Cost per m of moving at all, and on top of it of moving outwards.
_PRIOR, _OUTWARD = 1.0, 3.0
# Largest cost of a jump between neighbours.
_CAP = 0.4
# Share of a bump of the hull (m, at most _BUMP) that neighbours should even out.
_EVEN, _BUMP = 0.4, 0.02
# Agreement from which on a place is trusted wholly.
_AGREED = 0.3
_SWEEPS = 4
_NORMAL_ROUNDS = 4


class Round(NamedTuple):
    """One search along the normals: from `-outward` to `inward` by `step`, patches sampled by `spacing` (m)."""

    outward: float
    inward: float
    step: float
    spacing: float


class Mesh(NamedTuple):
    """What stays when vertices move."""

    faces: np.ndarray
    adjacency: scipy.sparse.csr_matrix
    graph: tuple[np.ndarray, np.ndarray, np.ndarray]
    owner: np.ndarray  # of each half edge


@node(over="frame", memory=1.0)
def refine(
    surfaces: Surfaces,
    footage: Footage,
    mattes: Mattes,
    cameras: Cameras,
    *,
    vertices: Annotated[int, Param("vertices", 0, 10_000_000, "kept at most; 0: as many as came in")] = 0,
    inward: Annotated[
        float, Param("m", 0.005, 0.5, "farthest that the hull may lie outside the surface")
    ] = 0.12,
    step: Annotated[
        float, Param("m", 0.0005, 0.05, "of the first search; the second takes half of it")
    ] = 0.008,
    edge: Annotated[float, Param("m", 0.002, 1.0, "longest edge of the mesh that is searched")] = 0.035,
    stiffness: Annotated[
        float, Param("1/m", 0.0, 1000.0, "cost of neighbours moving differently; 10 for a poor calibration")
    ] = 3.0,
) -> Surfaces:
    """The surface of the performer, moved along its normals to where the pictures agree; watertight as it came.

    vertices (V, 3) m, images (camera, y, x, 3), alpha (camera, y, x) -> a surface of at most `vertices`. Long edges
    are halved; then two rounds, coarse and fine, choose the depth d_v of every vertex below the surface by

    min sum_v (C_v(d_v) + prior |d_v|) + sum_edges min(stiffness |d_v - d_w - e_vw|, cap)

    with C the disagreement of the cameras that see the vertex best (`sweep_cost`: normalised correlation of patches
    across the normal, blind to a camera's gain) and e_vw a share of the hull's unevenness (so that its ridges need
    not come along). Where there is no texture C is 1 for every d and the vertex stays with its neighbours, or on the
    hull. Before each round and at the end vertices whose outlines fall short of a matte move out, and those outside one
    move in; folds are smoothed away.

    Raises ValueError where pictures, mattes and calibration do not belong together.
    Source: 004 section 2.2 and Starck and Hilton 2007, IEEE CGA 27(3) (hull, then the consistent surface inside it
    that still fills the silhouettes); Felzenszwalb and Huttenlocher 2006, IJCV 70(1) (belief propagation).
    Departure: a depth per vertex in place of a graph cut over voxels: the topology of the hull stays; no features are
    matched first, the whole depth range is searched.
    """
    refuse_mismatch("refine", footage.images.shape[:3], cameras.image_size, cameras.name)
    refuse_mismatch("refine", mattes.alpha.shape, cameras.image_size, cameras.name)
    rig = (cameras.matrix, cameras.rotation, cameras.translation, cameras.distortion)
    images = _pictures(footage.images, mattes.alpha)
    points, faces = split_long_edges(np.asarray(surfaces.vertices, np.float64), surfaces.faces, edge)
    mesh = _mesh(faces, len(points))
    spacing = edge / 3.5
    for level in (
        Round(2 * step, inward, step, spacing),
        Round(2 * step, 2 * step, 0.5 * step, 0.8 * spacing),
    ):
        points, windows, normals = _outlined(points, mesh, rig, mattes.alpha, _NORMAL_ROUNDS)
        points = _searched(points, normals, windows, mesh, images, camera_rows(*rig), level, stiffness)
    points = unfold(_outlined(points, mesh, rig, mattes.alpha, 1)[0], faces, mesh.adjacency)
    budget = vertices or len(surfaces.vertices)
    if len(points) > budget:
        points, faces = decimate(points, faces, budget)
    return Surfaces(points.astype(np.float32), faces.astype(np.int32), surfaces.fps)


def _pictures(images: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    """Pictures free of the finest noise, each with its matte: (camera, y, x, 4) float32, 0..255.

    Only the part that shows something is filled in; the rest is 0, as its matte is.
    """
    pictures = np.zeros((*alpha.shape, 4), np.float32)
    for picture, image, matte in zip(pictures, images, alpha, strict=True):
        x, y, width, height = cv2.boundingRect(np.ascontiguousarray(matte))
        part = slice(y, y + height), slice(x, x + width)
        if width and height:
            picture[part][..., :3] = cv2.GaussianBlur(np.ascontiguousarray(image[part]), (0, 0), 0.6)
            picture[part][..., 3] = matte[part]
    return pictures


def _mesh(faces: np.ndarray, count: int) -> Mesh:
    adjacency = vertex_adjacency(faces, count)
    graph = neighbour_lists(adjacency)
    return Mesh(faces, adjacency, graph, np.repeat(np.arange(count), np.diff(graph[0])))


def _outlined(
    points: np.ndarray, mesh: Mesh, rig: Rig, alpha: np.ndarray, rounds: int
) -> tuple[np.ndarray, list[MeshWindow | None], np.ndarray]:
    """The surface with its outlines at those of the mattes, and how the cameras saw it before; its normals."""
    normals = _even_normals(points, mesh, rounds)
    windows = mesh_windows(points, normals, mesh.faces, rig, alpha.shape[1:])
    push, weight = outline_offsets(windows, alpha)
    move = diffuse(push, weight, mesh.adjacency, smooth=1.0, keep=0.2, rounds=20)
    return points + move[:, None] * normals, windows, normals


def _searched(
    points: np.ndarray,
    normals: np.ndarray,
    windows: list[MeshWindow | None],
    mesh: Mesh,
    images: np.ndarray,
    rows: np.ndarray,
    level: Round,
    stiffness: float,
) -> np.ndarray:
    """Points at the depths that cost least, smoothed where there was something to see."""
    views = visible_views(windows, _MOST_VIEWS, _TOLERANCE, _LEAST_COSINE)
    depths = np.arange(-level.outward, level.inward + 0.5 * level.step, level.step)
    cost = sweep_cost(images, rows, points, normals, views, depths, level.spacing, _HALF)
    trust = np.clip((1 - cost.min(axis=1)) / _AGREED, 0, 1)
    cost += (_PRIOR * np.abs(depths) + _OUTWARD * np.maximum(-depths, 0)).astype(np.float32)
    bump = _bumps(points, normals, mesh) * np.minimum(trust[mesh.owner], trust[mesh.graph[1]])
    labels = beliefs(cost, mesh.graph, -bump / level.step, stiffness * level.step, _CAP, _SWEEPS)
    depth = depths[0] + level.step * _lowest(labels)
    depth = diffuse(depth, np.ones(len(depth)), mesh.adjacency, smooth=0.2, keep=0.0, rounds=8)
    moved = points - depth[:, None] * normals
    trust = diffuse(trust, np.ones(len(trust)), mesh.adjacency, smooth=0.5, keep=0.0, rounds=4)
    smoothed = moved + trust[:, None] * (taubin_smooth(moved, mesh.faces, 2) - moved)
    return unfold(smoothed, mesh.faces, mesh.adjacency)


def _bumps(points: np.ndarray, normals: np.ndarray, mesh: Mesh) -> np.ndarray:
    """Per half edge the share to even out of how far its first vertex stands out above its second, m."""
    start, end = mesh.owner, mesh.graph[1]
    mean = normals[start] + normals[end]
    mean /= np.maximum(np.linalg.norm(mean, axis=1, keepdims=True), 1e-9)
    height = ((points[start] - points[end]) * mean).sum(axis=1)
    return np.asarray(np.clip(_EVEN * height, -_BUMP, _BUMP))


def _even_normals(points: np.ndarray, mesh: Mesh, rounds: int) -> np.ndarray:
    """Vertex normals, averaged over the neighbours `rounds` times: the hull's own jump at its ridges."""
    normals = vertex_normals(points, mesh.faces)
    for _ in range(rounds):
        normals = normals + mesh.adjacency @ normals
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    return normals


def _lowest(cost: np.ndarray) -> np.ndarray:
    """Where each row (V, L) is least, between labels by the parabola through the least and its neighbours."""
    best = cost.argmin(axis=1)
    row, middle = np.arange(len(cost)), np.clip(best, 1, cost.shape[1] - 2)
    left, low, right = (cost[row, middle + k] for k in (-1, 0, 1))
    bend = left - 2 * low + right
    inner = (best == middle) & (bend > 1e-6)
    shift = np.where(inner, 0.5 * (left - right) / np.where(inner, bend, 1), 0)
    return np.asarray(best + np.clip(shift, -0.5, 0.5))
