"""How a solid is turned about the vertical against another."""

from __future__ import annotations

import numpy as np

from reperform.nodes.kernels.azimuth_correlation import azimuth_spectrum, correlate_azimuth
from reperform.nodes.kernels.spherical_histogram import spherical_histogram, volume_centroid

RADIAL, POLAR, AZIMUTH, REACH = 8, 12, 60, 1.2


def likely_turns(
    source: tuple[np.ndarray, np.ndarray], target: tuple[np.ndarray, np.ndarray], count: int
) -> list[tuple[float, np.ndarray]]:
    """Yaws (rad) that turn one mesh (vertices, faces) most nearly into another, and the shift (3,) that
    goes with each.

    Peaks of the correlation of spherical histograms over azimuth, best first. R_y(yaw) x + shift takes the
    source's volume centroid to the target's.
    """
    centres, spectra = [], []
    for vertices, faces in (target, source):
        vertices = np.ascontiguousarray(vertices, np.float64)
        _, centre = volume_centroid(vertices, faces)
        histogram = spherical_histogram(vertices, faces, centre, REACH, RADIAL, POLAR, AZIMUTH)
        weight = (np.arange(RADIAL) + 0.5) / RADIAL
        centres.append(centre)
        spectra.append(azimuth_spectrum(histogram[None], weight))
    correlation = correlate_azimuth(spectra[0], spectra[1], AZIMUTH)[0, 0]
    peaks = (correlation >= np.roll(correlation, 1)) & (correlation > np.roll(correlation, -1))
    best = sorted(np.flatnonzero(peaks), key=lambda k: (-correlation[k], k))[:count]
    turns = []
    for k in best:
        yaw = 2 * np.pi * k / AZIMUTH
        yaw -= 2 * np.pi * (yaw > np.pi)
        turns.append((float(yaw), centres[0] - turn_matrix(yaw) @ centres[1]))
    return turns


def turn_matrix(yaw: float) -> np.ndarray:
    """R_y(yaw), (3, 3): turns z towards x."""
    c, s = np.cos(yaw), np.sin(yaw)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
