"""A smooth body as a union of implicit parts: lofts along an axis and ellipsoids, blended where they meet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numba import njit
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

    Source: Quilez 2015, "Ellipsoid distance estimation"; the end caps are those of an extruded section.
    """
    return _distances(np.ascontiguousarray(points, np.float64), *_numbers(part))


def _numbers(part: Part) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """(start and frame (4, 3), (length, folds, phase), radii (3,) or empty, stations and sections (6, S))."""
    length = float(np.linalg.norm(np.subtract(part.end, part.start)))
    count = len(part.stations)
    zero = (0.0,) * count
    rows = (part.stations, part.half_u, part.half_w, part.shift_u or zero, part.shift_w or zero)
    profile = np.array([*rows, part.fold_depth or zero], float) if part.radii is None else np.zeros((6, 1))
    place = np.vstack([part.start, part_frame(part)])
    return place, np.array([length, part.folds, part.fold_phase]), np.array(part.radii or (), float), profile


@njit(cache=True, nogil=True)
def _distance(
    x: float, y: float, z: float, place: np.ndarray, shape: np.ndarray, radii: np.ndarray, profile: np.ndarray
) -> float:
    x, y, z = x - place[0, 0], y - place[0, 1], z - place[0, 2]
    u = x * place[1, 0] + y * place[1, 1] + z * place[1, 2]
    v = x * place[2, 0] + y * place[2, 1] + z * place[2, 2]
    w = x * place[3, 0] + y * place[3, 1] + z * place[3, 2]
    if len(radii):
        a, b, c = u / radii[0], v / radii[1], w / radii[2]
        k0 = np.sqrt(a * a + b * b + c * c)
        k1 = np.sqrt((a / radii[0]) ** 2 + (b / radii[1]) ** 2 + (c / radii[2]) ** 2)
        return k0 * (k0 - 1) / k1 if k1 > 1e-6 else -min(radii[0], radii[1], radii[2])
    t = v / shape[0]
    last = profile.shape[1] - 1
    k = 0
    while k < last - 1 and t > profile[0, k + 1]:
        k += 1
    s = min(max((t - profile[0, k]) / (profile[0, k + 1] - profile[0, k]), 0.0), 1.0)
    half_u = profile[1, k] + s * (profile[1, k + 1] - profile[1, k])
    half_w = profile[2, k] + s * (profile[2, k + 1] - profile[2, k])
    u -= profile[3, k] + s * (profile[3, k + 1] - profile[3, k])
    w -= profile[4, k] + s * (profile[4, k + 1] - profile[4, k])
    if shape[1] > 0:
        depth = profile[5, k] + s * (profile[5, k + 1] - profile[5, k])
        scale = 1 + depth * np.cos(shape[1] * np.arctan2(w, u) + shape[2])
        half_u *= scale
        half_w *= scale
    a, b = u / half_u, w / half_w
    k0 = np.sqrt(a * a + b * b)
    k1 = np.sqrt((a / half_u) ** 2 + (b / half_w) ** 2)
    across = k0 * (k0 - 1) / k1 if k1 > 1e-6 else -min(half_u, half_w)
    along = max(-t, t - 1) * shape[0]
    return min(max(across, along), 0.0) + np.sqrt(max(across, 0.0) ** 2 + max(along, 0.0) ** 2)


@njit(cache=True, nogil=True)
def _distances(
    points: np.ndarray, place: np.ndarray, shape: np.ndarray, radii: np.ndarray, profile: np.ndarray
) -> np.ndarray:
    found = np.empty(len(points))
    for n in range(len(points)):
        found[n] = _distance(points[n, 0], points[n, 1], points[n, 2], place, shape, radii, profile)
    return found


@njit(cache=True, nogil=True)
def _join(
    grid: np.ndarray, first: np.ndarray, stop: np.ndarray, lower: np.ndarray, voxel: float, blend: float, carve: bool,
    far: float, place: np.ndarray, shape: np.ndarray, radii: np.ndarray, profile: np.ndarray,
) -> None:  # fmt: skip
    """Join one part to (or carve it from) the grid inside its box; the smooth union is
    min(a, b) - max(blend - |a - b|, 0)^2 / (4 blend)."""
    for i in range(first[0], stop[0]):
        for j in range(first[1], stop[1]):
            for k in range(first[2], stop[2]):
                x, y, z = lower[0] + voxel * i, lower[1] + voxel * j, lower[2] + voxel * k
                b = _distance(x, y, z, place, shape, radii, profile)
                a = -grid[i, j, k] if carve else grid[i, j, k]
                h = max(blend - abs(a - b), 0.0)
                joined = min(a, b) - h * h * (0.25 / blend)
                grid[i, j, k] = -joined if carve else min(joined, far)


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


def distance_grid(
    parts: Sequence[Part], lower: np.ndarray, upper: np.ndarray, voxel: float, floor: bool = True
) -> np.ndarray:
    """Signed distance of the whole body at lower + voxel * (i, j, k), truncated far away; float32 (x, y, z).

    With `floor` nothing reaches below y = 0.
    """
    counts = np.ceil((upper - lower) / voxel).astype(int) + 1
    far = 4 * voxel
    grid = np.full(counts, far, np.float32)
    for part in parts:
        low, high = part_bounds(part, far + part.blend)
        first = np.clip(np.ceil((low - lower) / voxel), 0, counts).astype(int)
        stop = np.clip(np.floor((high - lower) / voxel) + 1, 0, counts).astype(int)
        _join(
            grid, first, stop, np.asarray(lower, float), voxel, part.blend, part.carve, far, *_numbers(part)
        )
    if floor:
        grid = np.maximum(grid, -(lower[1] + voxel * np.arange(counts[1])).astype(np.float32)[None, :, None])
    return grid


def nearest_part(points: np.ndarray, parts: Sequence[Part]) -> tuple[np.ndarray, np.ndarray]:
    """(index of the part whose surface is nearest or deepest, distances (N, P) with +inf out of reach)."""
    distances = np.full((len(points), len(parts)), np.inf, np.float32)
    for column, part in enumerate(parts):
        low, high = part_bounds(part, 0.06)
        near = _within(points, low, high)
        distance = part_distance(points[near], part)
        if part.carve:
            distances[near, :column] = np.maximum(distances[near, :column], -distance[:, None])
        else:
            distances[near, column] = distance
    return distances.argmin(axis=1), distances


@njit(cache=True, nogil=True)
def _within(points: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Indices of the points in a box."""
    found = np.empty(len(points), np.int64)
    count = 0
    for n in range(len(points)):
        inside = True
        for d in range(3):
            if points[n, d] < low[d] or points[n, d] > high[d]:
                inside = False
                break
        if inside:
            found[count] = n
            count += 1
    return found[:count]


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
