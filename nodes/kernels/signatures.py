"""Weighted point sets of many frames, and fewer points that stand for them."""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit

# frames of each take that say where the cells are
_SAMPLE = 24


class Signatures(NamedTuple):
    """Points of frame t: rows first[t] .. first[t + 1] of point (N, D), each with a mass (N,) > 0; a frame sums
    to 1.
    """

    first: np.ndarray
    mass: np.ndarray
    point: np.ndarray


class Planes(NamedTuple):
    """A tree of planes: at node s, points with axis[s] . x > offset[s] go to low[s], others to high[s]; a
    negative number -1 - c is cell c.
    """

    axis: np.ndarray
    offset: np.ndarray
    low: np.ndarray
    high: np.ndarray


def signatures(mass: Sequence[np.ndarray], point: Sequence[np.ndarray]) -> Signatures:
    """The frames one after the other, each scaled to mass 1."""
    first = np.cumsum([0, *map(len, mass)])
    scaled = np.concatenate([m / m.sum() for m in mass]) if len(mass) else np.zeros(0)
    return Signatures(first, scaled, np.concatenate(point).astype(np.float64))


def common_planes(takes: Sequence[Signatures], count: int) -> Planes:
    """Planes that cut what all frames of the takes hold into `count` cells.

    The cell of the largest scatter is cut through its mean, across its main axis, until there are enough; so
    frames that are alike fill the same cells alike.
    """
    point, mass = _sampled(takes)
    heap = [_part(point, mass, np.arange(len(point)), -1)]
    axis: list[np.ndarray] = []
    offset: list[float] = []
    links: list[list[int]] = []
    while len(heap) < count and heap[0][0] < 0:
        _, link, rows, direction, middle = heapq.heappop(heap)
        node = len(axis)
        axis.append(direction)
        offset.append(float(middle @ direction))
        links.append([0, 0])
        if link >= 0:
            links[link // 2][link % 2] = node
        above = point[rows] @ direction > offset[node]
        heapq.heappush(heap, _part(point, mass, rows[above], 2 * node))
        heapq.heappush(heap, _part(point, mass, rows[~above], 2 * node + 1))
    low, high = _numbered(np.array(links, np.int64).reshape(-1, 2), {part[1] for part in heap})
    return Planes(np.array(axis).reshape(-1, point.shape[1]), np.array(offset), low, high)


def _numbered(links: np.ndarray, leaves: set[int]) -> tuple[np.ndarray, np.ndarray]:
    """Both branches (node,) of every node, cells numbered so that neighbours in number are near in space."""
    cell = 0
    todo = [1, 0] if len(links) else []
    while todo:
        link = todo.pop()
        s, k = divmod(link, 2)
        if link in leaves:
            links[s, k] = -1 - cell
            cell += 1
        else:
            todo += [2 * int(links[s, k]) + 1, 2 * int(links[s, k])]
    return links[:, 0].copy(), links[:, 1].copy()


def _sampled(takes: Sequence[Signatures]) -> tuple[np.ndarray, np.ndarray]:
    points, masses = [], []
    for take in takes:
        frames = len(take.first) - 1
        for t in np.unique(np.linspace(0, frames - 1, min(frames, _SAMPLE)).round().astype(int)):
            rows = slice(take.first[t], take.first[t + 1])
            points.append(take.point[rows])
            masses.append(take.mass[rows])
    return np.concatenate(points), np.concatenate(masses)


def _part(
    point: np.ndarray, mass: np.ndarray, rows: np.ndarray, link: int
) -> tuple[float, int, np.ndarray, np.ndarray, np.ndarray]:
    """A cell to be cut: minus its largest scatter, where it hangs, its points, main axis and mean."""
    x, w = point[rows], mass[rows]
    if len(rows) < 2:
        return 0.0, link, rows, np.zeros(point.shape[1]), np.zeros(point.shape[1])
    mean = w @ x / w.sum()
    gap = x - mean
    value, vector = np.linalg.eigh((gap * w[:, None]).T @ gap)
    scatter = float(value[-1]) if value[-1] > 1e-12 * w.sum() else 0.0
    return -scatter, link, rows, vector[:, -1], mean


@njit(cache=True, nogil=True)
def cells_of(point: np.ndarray, planes: Planes) -> np.ndarray:
    """The cell (N,) of every point (N, D)."""
    cell = np.zeros(len(point), np.int64)
    if len(planes.offset) == 0:
        return cell
    for i in range(len(point)):
        s = 0
        while s >= 0:
            along = 0.0
            for k in range(point.shape[1]):
                along += point[i, k] * planes.axis[s, k]
            s = planes.low[s] if along > planes.offset[s] else planes.high[s]
        cell[i] = -1 - s
    return cell


def merged(take: Signatures, planes: Planes) -> Signatures:
    """One point per frame and filled cell: the mean of what the cell holds, with its mass."""
    count, frames = len(planes.offset) + 1, len(take.first) - 1
    frame = np.repeat(np.arange(frames), np.diff(take.first))
    key = frame * count + cells_of(take.point, planes)
    mass = np.bincount(key, take.mass, minlength=frames * count)
    filled = mass > 0
    sums = np.column_stack([np.bincount(key, take.mass * x, minlength=len(mass)) for x in take.point.T])
    first = np.concatenate([[0], np.cumsum(filled.reshape(frames, count).sum(axis=1))])
    return Signatures(first, mass[filled], sums[filled] / mass[filled, None])


def single(take: Signatures, frame: int) -> Signatures:
    """One frame by itself."""
    rows = slice(take.first[frame], take.first[frame + 1])
    return Signatures(np.array([0, rows.stop - rows.start]), take.mass[rows], take.point[rows])
