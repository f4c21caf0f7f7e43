"""A smooth body as a union of implicit parts: lofts along an axis and ellipsoids, blended where they meet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D


@dataclass(frozen=True)
class Part:
    """One implicit part in the rest pose; lengths in metres.

    With `radii` it is an ellipsoid at `start` whose axes are `side`, `end - start`, their cross product.
    Without, it is a loft from `start` to `end`: at stations t in [0, 1] an ellipse of half axes `half_u`
    along `side` and `half_w` along side x axis, its centre moved by `shift_u`, `shift_w`; both ends are
    flat. `folds` waves of relative `fold_depth` run around the section. `carve` removes the part from what
    was built before it.
    """

    name: str
    material: str
    bones: tuple[str, ...]
    start: tuple[float, float, float]
    end: tuple[float, float, float]
    side: tuple[float, float, float] = (1.0, 0.0, 0.0)
    stations: tuple[float, ...] = (0.0, 1.0)
    half_u: tuple[float, ...] = (0.05, 0.05)
    half_w: tuple[float, ...] = (0.05, 0.05)
    shift_u: tuple[float, ...] = ()
    shift_w: tuple[float, ...] = ()
    radii: tuple[float, float, float] | None = None
    # where along the axis (in t) each of `bones` holds the part alone
    knots: tuple[float, ...] = (0.0,)
    blend: float = 0.01
    folds: int = 0
    fold_depth: tuple[float, ...] = ()
    fold_phase: float = 0.0
    carve: bool = False
    # how far the part moves after the body at its stations: 0 fixed, 1 free
    looseness: tuple[float, ...] = field(default=())


def part_frame(part: Part) -> np.ndarray:
    """Rows: side, axis, side x axis; orthonormal."""
    axis = np.subtract(part.end, part.start).astype(float)
    axis /= np.linalg.norm(axis)
    side = np.asarray(part.side, float)
    side = side - axis * (side @ axis)
    side /= np.linalg.norm(side)
    return np.stack([side, axis, np.cross(side, axis)])


def part_coordinates(points: np.ndarray, part: Part) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(along the axis in t, metres along u, metres along w from the section's centre) of points (N, 3)."""
    local = (points - np.asarray(part.start, points.dtype)) @ part_frame(part).T.astype(points.dtype)
    length = float(np.linalg.norm(np.subtract(part.end, part.start)))
    t = local[:, 1] / length
    u, w = local[:, 0], local[:, 2]
    if part.shift_u:
        u = u - np.interp(t, part.stations, part.shift_u).astype(points.dtype)
    if part.shift_w:
        w = w - np.interp(t, part.stations, part.shift_w).astype(points.dtype)
    return t, u, w


def part_distance(points: np.ndarray, part: Part) -> np.ndarray:
    """Approximate signed distance (m, negative inside) of points (N, 3) to a part, exact to first order.

    For an ellipse with k0 = |q / r| and k1 = |q / r^2| the distance is k0 (k0 - 1) / k1.
    """
    tiny = np.asarray(1e-6, points.dtype)
    if part.radii is not None:
        q = (points - np.asarray(part.start, points.dtype)) @ part_frame(part).T.astype(points.dtype)
        q = q / np.asarray(part.radii, points.dtype)
        k0 = np.sqrt((q * q).sum(1))
        q = q / np.asarray(part.radii, points.dtype)
        k1 = np.sqrt((q * q).sum(1))
        return k0 * (k0 - 1) / np.maximum(k1, tiny)
    t, u, w = part_coordinates(points, part)
    half_u = np.interp(t, part.stations, part.half_u).astype(points.dtype)
    half_w = np.interp(t, part.stations, part.half_w).astype(points.dtype)
    if part.folds:
        depth = np.interp(t, part.stations, part.fold_depth)
        wave = np.cos(part.folds * np.arctan2(w, u) + part.fold_phase)
        scale = (1 + depth * wave).astype(points.dtype)
        half_u, half_w = half_u * scale, half_w * scale
    u, w = u / half_u, w / half_w
    k0 = np.hypot(u, w)
    k1 = np.hypot(u / half_u, w / half_w)
    across = np.where(k1 > tiny, k0 * (k0 - 1) / np.maximum(k1, tiny), -np.minimum(half_u, half_w))
    length = np.asarray(np.linalg.norm(np.subtract(part.end, part.start)), points.dtype)
    along = np.maximum(-t, t - 1) * length
    inside = np.minimum(np.maximum(across, along), 0)
    return inside + np.hypot(np.maximum(across, 0), np.maximum(along, 0))


def part_bounds(part: Part, margin: float) -> tuple[np.ndarray, np.ndarray]:
    """Corners of a box that holds every point nearer to the part than `margin`."""
    start, end = np.asarray(part.start), np.asarray(part.end)
    if part.radii is not None:
        reach = max(part.radii) + margin
        return start - reach, start + reach
    widest = 1 + max(part.fold_depth, default=0.0)
    reach = max(*part.half_u, *part.half_w) * widest + margin
    reach += max((abs(shift) for shift in (*part.shift_u, *part.shift_w)), default=0.0)
    return np.minimum(start, end) - reach, np.maximum(start, end) + reach


def smooth_union(a: np.ndarray, b: np.ndarray, blend: float) -> np.ndarray:
    """Minimum of two distances, rounded over `blend` metres: min(a, b) - max(blend - |a - b|, 0)^2 / (4
    blend).
    """
    h = np.maximum(blend - np.abs(a - b), 0)
    return np.minimum(a, b) - h * h * (0.25 / blend)


def distance_grid(
    parts: Sequence[Part], lower: np.ndarray, upper: np.ndarray, voxel: float, floor: bool = True
) -> np.ndarray:
    """Signed distance of the whole body at lower + voxel * (i, j, k), truncated far away; float32 (x, y, z).

    With `floor` nothing reaches below y = 0.
    """
    counts = np.ceil((upper - lower) / voxel).astype(int) + 1
    axes = [(lower[d] + voxel * np.arange(counts[d])).astype(np.float32) for d in range(3)]
    far = 4 * voxel
    grid = np.full(counts, far, np.float32)
    for part in parts:
        low, high = part_bounds(part, far + part.blend)
        box = tuple(slice(*np.searchsorted(axes[d], (low[d], high[d]))) for d in range(3))
        block = grid[box]
        points = np.stack(np.meshgrid(*(axes[d][box[d]] for d in range(3)), indexing="ij"), axis=-1)
        distance = part_distance(points.reshape(-1, 3), part).astype(np.float32).reshape(block.shape)
        if part.carve:
            grid[box] = -smooth_union(-block, distance, part.blend)
        else:
            grid[box] = np.minimum(smooth_union(block, distance, part.blend), far)
    if floor:
        grid = np.maximum(grid, -axes[1][None, :, None])
    return grid


def nearest_part(points: np.ndarray, parts: Sequence[Part]) -> tuple[np.ndarray, np.ndarray]:
    """(index of the part whose surface is nearest or deepest, distances (N, P) with +inf out of reach)."""
    distances = np.full((len(points), len(parts)), np.inf, np.float32)
    for column, part in enumerate(parts):
        low, high = part_bounds(part, 0.06)
        near = np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
        distance = part_distance(points[near], part)
        if part.carve:
            distances[near, :column] = np.maximum(distances[near, :column], -distance[:, None])
        else:
            distances[near, column] = distance
    return distances.argmin(axis=1), distances


def isosurface(grid: np.ndarray, lower: np.ndarray, voxel: float) -> tuple[np.ndarray, np.ndarray]:
    """Zero level of a distance grid: vertices (V, 3) float32, faces (F, 3) int32, counter-clockwise from
    outside.

    Source: Schroeder, Maynard, Geveci 2015, "Flying edges" (VTK's implementation).
    """
    image = vtkImageData()
    image.SetDimensions(*grid.shape)
    image.SetSpacing(voxel, voxel, voxel)
    image.SetOrigin(*(float(value) for value in lower))
    image.GetPointData().SetScalars(numpy_to_vtk(grid.ravel(order="F"), deep=1))
    contour = vtkFlyingEdges3D()
    contour.SetInputData(image)
    contour.SetValue(0, 0.0)
    contour.ComputeNormalsOff()
    contour.ComputeGradientsOff()
    contour.Update()
    vertices = vtk_to_numpy(contour.GetOutput().GetPoints().GetData()).astype(np.float32)
    faces = vtk_to_numpy(contour.GetOutput().GetPolys().GetConnectivityArray()).reshape(-1, 3)
    # the field falls inwards: VTK winds towards rising values
    return vertices, np.ascontiguousarray(faces[:, ::-1], np.int32)
