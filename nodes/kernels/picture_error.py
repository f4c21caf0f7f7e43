"""How far one picture is from another, over a mask: PSNR and SSIM."""

from __future__ import annotations

import cv2
import numpy as np


def psnr(picture: np.ndarray, truth: np.ndarray, mask: np.ndarray | None = None) -> float:
    """Peak signal-to-noise ratio in dB: 10 log10(255^2 / mean squared error over the mask's pixels and
    channels).

    picture, truth (H, W, 3), 0..255; mask (H, W) bool, all pixels by default. inf where equal; nan on no
    pixel.
    """
    _check(picture, truth, mask)
    difference = picture.astype(np.float64) - truth.astype(np.float64)
    squared = np.square(difference if mask is None else difference[mask])
    if squared.size == 0:
        return float("nan")
    mean = float(squared.mean())
    return float("inf") if mean == 0 else 10 * float(np.log10(255.0**2 / mean))


def ssim(picture: np.ndarray, truth: np.ndarray, mask: np.ndarray | None = None) -> float:
    """Structural similarity, mean over the mask of the map of the grey pictures (0..1 as a rule; 1 = equal).

    Gaussian window of sigma 1.5 px (11 x 11), C1 = (0.01 255)^2, C2 = (0.03 255)^2:
    (2 m_a m_b + C1)(2 s_ab + C2) / ((m_a^2 + m_b^2 + C1)(s_a^2 + s_b^2 + C2)). Grey = 0.299 R + 0.587 G +
    0.114 B.

    Source: Wang, Bovik, Sheikh and Simoncelli 2004, IEEE TIP 13(4).
    """
    _check(picture, truth, mask)
    luma = np.array([0.299, 0.587, 0.114])
    a, b = picture.astype(np.float64) @ luma, truth.astype(np.float64) @ luma
    mean_a, mean_b = _blur(a), _blur(b)
    spread_a, spread_b = _blur(a * a) - mean_a**2, _blur(b * b) - mean_b**2
    together = _blur(a * b) - mean_a * mean_b
    c1, c2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
    similarity = ((2 * mean_a * mean_b + c1) * (2 * together + c2)) / (
        (mean_a**2 + mean_b**2 + c1) * (spread_a + spread_b + c2)
    )
    chosen = similarity if mask is None else similarity[mask]
    return float(chosen.mean()) if chosen.size else float("nan")


def _blur(picture: np.ndarray) -> np.ndarray:
    return cv2.GaussianBlur(picture, (11, 11), 1.5)


def _check(picture: np.ndarray, truth: np.ndarray, mask: np.ndarray | None) -> None:
    if picture.shape != truth.shape or (mask is not None and mask.shape != picture.shape[:2]):
        raise ValueError(
            f"picture error: picture, truth and mask need one size, got {picture.shape}, {truth.shape} and "
            f"{None if mask is None else mask.shape}: compare views of the same camera"
        )
