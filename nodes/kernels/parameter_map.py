"""From what the user asks of a motion to the controls that do it: the inverse of a sampled map."""

from __future__ import annotations

from itertools import combinations_with_replacement, permutations
from typing import Literal, NamedTuple

import numpy as np
from numba import njit
from scipy.interpolate import PchipInterpolator, RBFInterpolator

from reperform.nodes.kernels.control_cells import Cells, framed, lattice, locate

Method = Literal["monotone", "rbf", "polynomial"]
# entries of the tabulated inverse per parameter, for 1, 2, 3 parameters
GRID = {1: 257, 2: 33, 3: 13}
_DEGREE = 3


class ParameterMap(NamedTuple):
    """Controls tabulated over a regular grid of parameters (last parameter fastest)."""

    lower: np.ndarray
    upper: np.ndarray
    grid: np.ndarray
    # (entries, d)
    inverse: np.ndarray


def sample_cells(
    control: np.ndarray, corners: np.ndarray, parts: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Blends all over the cells, `parts` to an edge: weights (S, N), controls (S, d), small cells (C', d + 1).

    Small cells are the lattice simplices into which each cell is cut, by their corners among the samples.
    """
    weights, places = lattice(corners, parts)
    return weights, weights @ control, _small_cells(places, corners.shape[1] - 1, parts)


def _small_cells(places: np.ndarray, d: int, parts: int) -> np.ndarray:
    """Kuhn's simplices of every cell, by their corners among the lattice points."""
    base = parts + 1
    scale = base ** np.arange(d - 1, -1, -1)
    found = []
    for tails in combinations_with_replacement(range(parts, -1, -1), d):
        for order in permutations(range(d)):
            code = np.array(tails)
            chain = [code.copy()]
            for axis in order:
                code = code.copy()
                code[axis] += 1
                chain.append(code)
            inside = all(c[0] <= parts and (np.diff(c) <= 0).all() for c in chain)
            if inside:
                found.append([int(c @ scale) for c in chain])
    return np.concatenate([row[np.array(found)] for row in places])


def orientation(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Signed volumes (C,) of simplices (C, d + 1) over points (P, d)."""
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    return np.asarray(np.linalg.det(edges))


def invert(method: Method, values: np.ndarray, controls: np.ndarray, small: np.ndarray) -> ParameterMap:
    """The map from parameters to controls through samples: values (S, d) of motions at controls (S, d).

    monotone: piecewise cubic without overshoot for one parameter (Fritsch and Carlson), linear within the small
    cells (C', d + 1) for more, continued outside them; rbf: thin-plate splines; polynomial: least squares of degree 3.
    """
    lower, upper = values.min(axis=0), values.max(axis=0)
    d = values.shape[1]
    grid = np.full(d, GRID[d], np.int32)
    axes = [np.linspace(low, high, GRID[d]) for low, high in zip(lower, upper, strict=True)]
    wanted = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, d)
    span = upper - lower
    x, y = (values - lower) / span, (wanted - lower) / span
    if method == "polynomial":
        inverse = _powers(y) @ np.linalg.lstsq(_powers(x), controls, rcond=None)[0]
    elif method == "rbf":
        neighbours = None if len(x) <= 500 else 60
        inverse = RBFInterpolator(x, controls, neighbors=neighbours, kernel="thin_plate_spline")(y)
    elif d == 1:
        order = np.argsort(x[:, 0], kind="stable")
        inverse = PchipInterpolator(x[order, 0], controls[order])(y[:, 0])
    else:
        inverse = np.empty_like(y)
        _through_cells(y, controls, small, framed(x, small), inverse)
    return ParameterMap(lower, upper, grid, np.ascontiguousarray(inverse))


@njit(cache=True, nogil=True)
def _through_cells(
    wanted: np.ndarray, controls: np.ndarray, corners: np.ndarray, cells: Cells, out: np.ndarray
) -> None:
    """The control at each wanted point, linear in the cell that holds it or, clamped, in the nearest one."""
    weight = np.empty(corners.shape[1])
    for k in range(len(wanted)):
        cell = locate(wanted[k], cells, weight)
        out[k] = 0.0
        for corner in range(corners.shape[1]):
            for axis in range(controls.shape[1]):
                out[k, axis] += weight[corner] * controls[corners[cell, corner], axis]


def _powers(x: np.ndarray) -> np.ndarray:
    columns = [np.ones(len(x))]
    for degree in range(1, _DEGREE + 1):
        for factors in combinations_with_replacement(range(x.shape[1]), degree):
            columns.append(np.prod(x[:, factors], axis=1))
    return np.stack(columns, axis=1)


@njit(cache=True, nogil=True)
def controls_at(wanted: np.ndarray, table: ParameterMap, out: np.ndarray) -> None:
    """The controls (d,) for parameters (d,), multilinear in the table; parameters are clamped to its range."""
    d = len(wanted)
    out[:] = 0.0
    for choice in range(1 << d):
        share, entry = 1.0, 0
        for k in range(d):
            count = table.grid[k]
            place = (wanted[k] - table.lower[k]) / (table.upper[k] - table.lower[k]) * (count - 1)
            place = min(max(place, 0.0), count - 1.0)
            low = min(int(place), count - 2)
            high = (choice >> k) & 1
            share *= place - low if high else 1.0 - (place - low)
            entry = entry * count + low + high
        if share > 0.0:
            for k in range(d):
                out[k] += share * table.inverse[entry, k]
