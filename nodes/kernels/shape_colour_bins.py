"""Where a coloured surface lies and what colour it has, counted in bins."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class SparseHistogram(NamedTuple):
    """Numbers of the filled bins in order, and the share, mean point (m) and mean colour of what each holds."""

    bin: np.ndarray
    share: np.ndarray
    point: np.ndarray
    colour: np.ndarray


def shape_colour_bins(
    points: np.ndarray, colours: np.ndarray, weights: np.ndarray, bins: tuple[int, ...], reach: float
) -> SparseHistogram:
    """Count points (N, 3), m from the centre, of colours (N, 3) in 0 .. 1, each with a weight (N,), in six
    dimensions: radius, polar angle from straight up, azimuth from z towards x, red, green, blue.

    What lies past `reach` counts in the outermost shell.
    """
    radius = np.sqrt((points**2).sum(axis=1))
    polar = np.arccos(np.clip(points[:, 1] / np.maximum(radius, 1e-12), -1, 1)) / np.pi
    azimuth = np.arctan2(points[:, 0], points[:, 2]) / (2 * np.pi) % 1
    scaled = np.column_stack([radius / reach, polar, azimuth, colours])
    cells = np.clip(np.floor(scaled * bins), 0, np.array(bins) - 1).astype(np.int64)
    number, entry = np.unique(np.ravel_multi_index(tuple(cells.T), bins), return_inverse=True)
    mass = np.bincount(entry, weights)

    filled = mass > 0

    def mean(values: np.ndarray) -> np.ndarray:
        sums = np.column_stack([np.bincount(entry, weights * column) for column in values.T])
        return sums[filled] / mass[filled, None]

    share = mass[filled] / mass.sum()
    return SparseHistogram(number[filled].astype(np.int32), share, mean(points), mean(colours))
