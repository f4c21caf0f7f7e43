"""Rotation about the vertical by correlation of histograms over azimuth."""

from __future__ import annotations

import numpy as np

ROWS = 48


def azimuth_spectrum(share: np.ndarray, radial_weight: np.ndarray) -> np.ndarray:
    """Fourier coefficients (frequency, T, radial * polar) over azimuth of histograms (T, radial, polar,
    azimuth), each histogram first scaled to length 1 under the radial weights (radial,).
    """
    weighted = share.astype(np.float64) * np.sqrt(radial_weight)[None, :, None, None]
    length = np.sqrt((weighted**2).sum(axis=(1, 2, 3), keepdims=True))
    spectrum = np.fft.rfft(weighted / np.maximum(length, 1e-300), axis=3)
    return np.ascontiguousarray(spectrum.reshape(len(share), -1, spectrum.shape[3]).transpose(2, 0, 1))


def correlate_azimuth(spectrum_a: np.ndarray, spectrum_b: np.ndarray, azimuth: int) -> np.ndarray:
    """Correlation (Ta, Tb, azimuth) of every a with every b turned by each whole bin about the vertical; 1
    for equal.

    Entry k belongs to the turn of b by 2 pi k / azimuth (positive from z towards x).
    """
    product = np.matmul(spectrum_a, spectrum_b.conj().transpose(0, 2, 1))
    return np.fft.irfft(product.transpose(1, 2, 0), n=azimuth, axis=2)


def least_azimuth_distance(spectrum_a: np.ndarray, spectrum_b: np.ndarray, azimuth: int) -> np.ndarray:
    """Euclidean distance (Ta, Tb) of the scaled histograms, least over turns by whole bins about the
    vertical."""
    distance = np.empty((spectrum_a.shape[1], spectrum_b.shape[1]))
    for first in range(0, len(distance), ROWS):
        rows = slice(first, first + ROWS)
        best = correlate_azimuth(spectrum_a[:, rows], spectrum_b, azimuth).max(axis=2)
        distance[rows] = np.sqrt(np.maximum(2 - 2 * best, 0))
    return distance
