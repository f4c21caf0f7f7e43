"""Soft alpha along the edge of a mask, from the colours on both sides."""

from __future__ import annotations

import cv2
import numpy as np


def refine_alpha(
    image: np.ndarray,
    inside: np.ndarray,
    outside: np.ndarray,
    rough: np.ndarray,
    backing: np.ndarray | None,
    reach: float,
    noise: float,
) -> np.ndarray:
    """Coverage (y, x) float32 in 0 .. 1: 1 inside, 0 outside, in the band between by colour.

    image (y, x, 3) float32; inside, outside (y, x) bool, certain pixels; rough: coverage where a side is out of
    reach; backing (y, x, 3) float32: the colour behind, or None to take it from the outside. With the foreground
    F and the background B, Gaussian means over the certain pixels within about `reach` px,
    alpha = <I - B, F - B> / (|F - B|^2 + noise^2), pulled to `rough` where F and B differ by less than the noise.

    Source: Mishima 1992 (US 5355174); Smith and Blinn 1996, SIGGRAPH (the matting equation I = aF + (1 - a)B).
    """
    front, front_near = _spread(image, inside, reach)
    if backing is None:
        back, back_near = _spread(image, outside, reach)
    else:
        back, back_near = backing, np.ones(inside.shape, bool)
    step = front - back
    length = (step * step).sum(axis=2)
    alpha = ((image - back) * step).sum(axis=2) / np.maximum(length, 1e-3)
    trust = length / (length + np.float32((3 * noise) ** 2 * 3))
    trust[~(front_near & back_near)] = 0
    alpha = np.clip(trust * alpha + (1 - trust) * rough, 0, 1)
    alpha[inside] = 1
    alpha[outside] = 0
    return alpha


def _spread(image: np.ndarray, mask: np.ndarray, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Gaussian mean colour of the masked pixels around each pixel, and whether there are any."""
    weight = mask.astype(np.float32)
    stacked = np.dstack([image * weight[..., None], weight])
    near = cv2.GaussianBlur(stacked, (0, 0), reach)
    near += np.float32(1e-3) * cv2.GaussianBlur(stacked, (0, 0), 3 * reach)
    total = near[..., 3:]
    return near[..., :3] / np.maximum(total, 1e-12), total[..., 0] > 1e-6
