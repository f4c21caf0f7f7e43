"""Weights between examples that lie scattered in a space of controls: cells of examples that blend with each other."""

from __future__ import annotations

from itertools import combinations_with_replacement
from typing import NamedTuple

import numpy as np
from numba import njit
from scipy.spatial import Delaunay, QhullError

# cells flatter than this share of the unit cube are left out
_FLAT = 1e-7


class Cells(NamedTuple):
    """Intervals, triangles or tetrahedra of examples, with what it takes to find weights in them."""

    # examples at the corners of each cell (C, d + 1)
    corners: np.ndarray
    # control of the last corner, and the matrix from a control relative to it to the weights of the others
    origin: np.ndarray
    matrix: np.ndarray


def cells_of(control: np.ndarray) -> np.ndarray:
    """The cells (C, d + 1) of examples at controls (N, d), d from 1 to 3: neighbours, or Delaunay's simplices.

    Raises ValueError where the examples do not span d dimensions.
    """
    count, d = control.shape
    if d == 1:
        order = np.argsort(control[:, 0], kind="stable")
        return np.column_stack([order[:-1], order[1:]]).astype(np.int32)
    try:
        corners = np.sort(Delaunay(control).simplices, axis=1)
    except (QhullError, ValueError) as error:
        raise ValueError(
            f"{d} parameters need at least {d + 1} takes that differ in all of them, got {count} takes in one line "
            "or plane: add takes, or control fewer parameters"
        ) from error
    edges = control[corners[:, :-1]] - control[corners[:, -1:]]
    corners = corners[np.abs(np.linalg.det(edges)) > _FLAT]
    return corners[np.lexsort(corners.T[::-1])].astype(np.int32)


def framed(control: np.ndarray, corners: np.ndarray) -> Cells:
    """Cells ready for `locate`."""
    edges = control[corners[:, :-1]] - control[corners[:, -1:]]
    matrix = np.linalg.inv(np.swapaxes(edges, 1, 2))
    return Cells(
        np.ascontiguousarray(corners, np.int32),
        np.ascontiguousarray(control[corners[:, -1]], np.float64),
        np.ascontiguousarray(matrix),
    )


@njit(cache=True, nogil=True)
def locate(control: np.ndarray, cells: Cells, weight: np.ndarray) -> int:
    """The cell that holds a control (d,), and the weights (d + 1,) of its corners in `weight`.

    Outside all cells: the cell it is least outside of, with negative weights at 0 and the rest scaled to sum 1.
    """
    d = len(control)
    best, least = 0, -np.inf
    for cell in range(len(cells.corners)):
        rest, low = 1.0, np.inf
        for row in range(d):
            value = 0.0
            for column in range(d):
                value += cells.matrix[cell, row, column] * (control[column] - cells.origin[cell, column])
            rest -= value
            low = min(low, value)
        low = min(low, rest)
        if low > least:
            best, least = cell, low
        if low >= 0.0:
            break
    total = 0.0
    rest = 1.0
    for row in range(d):
        value = 0.0
        for column in range(d):
            value += cells.matrix[best, row, column] * (control[column] - cells.origin[best, column])
        rest -= value
        weight[row] = max(value, 0.0)
        total += weight[row]
    weight[d] = max(rest, 0.0)
    total += weight[d]
    for corner in range(d + 1):
        weight[corner] /= total
    return best


@njit(cache=True, nogil=True)
def blend_weights(control: np.ndarray, cells: Cells, scratch: np.ndarray, out: np.ndarray) -> None:
    """Weights of all examples (N,) at a control; scratch: (d + 1,)."""
    cell = locate(control, cells, scratch)
    out[:] = 0.0
    for corner in range(len(scratch)):
        out[cells.corners[cell, corner]] += scratch[corner]


@njit(cache=True, nogil=True)
def lattice_point(corner_weight: np.ndarray, halves: int, place: np.ndarray, weight: np.ndarray) -> None:
    """The d + 1 lattice points of a cell, cut into `halves` along each edge, between which a point lies.

    corner_weight: (d + 1,) of sum 1; overwritten. Out: place (d + 1,) and weight (d + 1,) of sum 1. A lattice point
    with weights b / halves is called by its tail sums a_j = b_j + .. + b_d, j = 1 .. d, read as digits in base
    halves + 1.

    Source: Kuhn 1960, IBM J. Res. Dev. 4 (the subdivision of a simplex along its lattice).
    """
    d = len(corner_weight) - 1
    base = halves + 1
    code, scale, tail = 0, 1, 0.0
    for j in range(d, 0, -1):
        tail += corner_weight[j]
        # a rounding error must not push the point out of the cell
        value = min(tail, 1.0) * halves
        whole = min(int(np.floor(value + 1e-12)), halves)
        code += whole * scale
        scale *= base
        corner_weight[j] = max(value - whole, 0.0)
    place[0] = code
    before = 1.0
    for k in range(1, d + 1):
        # the first of the greatest fractions left, so that tail sums never rise
        chosen = 1
        for j in range(2, d + 1):
            if corner_weight[j] > corner_weight[chosen]:
                chosen = j
        weight[k - 1] = before - corner_weight[chosen]
        before = corner_weight[chosen]
        code += base ** (d - chosen)
        place[k] = code if before > 0.0 else place[k - 1]
        corner_weight[chosen] = -1.0
    weight[d] = before


def lattice(corners: np.ndarray, halves: int) -> tuple[np.ndarray, np.ndarray]:
    """All lattice points of all cells: weights (points, examples), and where each cell has them.

    The second array (cells, (halves + 1)^d) gives the point at each place of `lattice_point`, -1 where none is.
    Points on a common side of two cells are one point; the first points are the examples themselves.
    """
    count, d = int(corners.max()) + 1, corners.shape[1] - 1
    index = {_key(row): k for k, row in enumerate(np.eye(count, dtype=np.int64) * halves)}
    rows = list(np.eye(count, dtype=np.int64) * halves)
    places = np.full((len(corners), (halves + 1) ** d), -1, np.int32)
    for cell, corner in enumerate(corners):
        for tails in combinations_with_replacement(range(halves, -1, -1), d):
            shares = np.diff([0, *tails[::-1]])[::-1]
            row = np.zeros(count, np.int64)
            row[corner[0]] = halves - tails[0]
            row[corner[1:]] = shares
            key = _key(row)
            if key not in index:
                index[key] = len(rows)
                rows.append(row)
            code = 0
            for tail in tails:
                code = code * (halves + 1) + tail
            places[cell, code] = index[key]
    return np.array(rows) / halves, places


def _key(row: np.ndarray) -> tuple[int, ...]:
    return tuple(row.tolist())
