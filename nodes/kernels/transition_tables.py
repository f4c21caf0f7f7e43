"""Precomputed distances along one edge of a parametric motion graph, ready for the search."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from reperform.nodes.kernels.control_cells import Cells, lattice_point, locate


class SpaceTables(NamedTuple):
    """One space as the search sees it."""

    cells: Cells
    # (C, places) -> reference
    lattice: np.ndarray
    halves: int
    cyclic: bool
    # (R, 2 K + 1) seconds from pose 0 of the run before to each pose
    clock: np.ndarray
    # (K,) seconds from each pose to the next, at the quickest
    quickest: np.ndarray
    # (K, R, R) m^2
    spread: np.ndarray
    # (K, R, R) m^2: products of the references' steps to the next pose
    stride: np.ndarray
    control: np.ndarray


class EdgeTables(NamedTuple):
    """One edge: source and target space, and squared distances (Ks, Rs, Kt, Rt)."""

    source: SpaceTables
    target: SpaceTables
    distance: np.ndarray
    # (Ks, Kt): nothing is nearer between these poses and the next, for passing over those that cannot win
    least: np.ndarray
    largest: float


@njit(cache=True, nogil=True)
def reference_weights(
    space: SpaceTables, control: np.ndarray, corner: np.ndarray, reference: np.ndarray, weight: np.ndarray
) -> None:
    """The d + 1 references between which a control lies, and their weights; corner: (d + 1,) scratch."""
    cell = locate(control, space.cells, corner)
    lattice_point(corner, space.halves, reference, weight)
    for k in range(len(reference)):
        reference[k] = space.lattice[cell, reference[k]]


@njit(cache=True, nogil=True)
def clock_span(first: int, at: int, direction: int, poses: int) -> tuple[int, int, int]:
    """Where on a clock of two runs the way between two poses begins and ends, and how many runs it takes besides."""
    early, late = (first, at) if direction > 0 else (at, first)
    shift = -int(np.floor(early / poses)) * poses
    early, late, runs = early + shift, late + shift, 0
    while late > 2 * poses:
        late -= poses
        runs += 1
    return early, late, runs
