"""Photographs and what was keyed from them: footage, clean plates, mattes, films."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reperform.nodes.products.footage import CleanPlate, Film, Footage, Mattes
from reperform.viewer.pictures.canvas import grid, on_page
from reperform.viewer.pictures.look import Look


def footage_picture(product: Footage, frame: int, look: Look) -> np.ndarray:
    """All cameras of one frame in a grid, or the one that the look names."""
    return _cameras(product.images, frame, look)


def mattes_picture(product: Mattes, frame: int, look: Look) -> np.ndarray:
    """The mattes of all cameras of one frame in a grid: white belongs to the performer."""
    return _cameras(product.alpha, frame, look)


def plate_picture(product: CleanPlate, frame: int, look: Look) -> np.ndarray:
    """The empty set of each camera, and below it the spread of its noise, eight times as bright."""
    chosen = _chosen(int(product.mean.shape[0]), look)
    means = [_bytes(np.asarray(product.mean[k])) for k in chosen]
    spreads = [_bytes(8 * np.asarray(product.deviation[k])) for k in chosen]
    labels = [f"camera {k}" for k in chosen] + [f"camera {k}: deviation x 8" for k in chosen]
    return grid([*means, *spreads], labels, look.size)


def film_picture(product: Film, frame: int, look: Look) -> np.ndarray:
    """One frame of a film, as large as the page."""
    return on_page(np.asarray(product.images[frame]), look.size, "#15181c")


def film_strip(product: Film, look: Look, count: int = 6) -> np.ndarray:
    """Frames of a film from first to last, with their times in seconds."""
    frames = np.unique(np.linspace(0, product.images.shape[0] - 1, count).round().astype(int))
    rate = float(np.asarray(product.fps))
    labels = [f"{frame / rate:.2f} s" if rate > 0 else f"frame {frame}" for frame in frames]
    return grid([np.asarray(product.images[int(frame)]) for frame in frames], labels, look.size)


def _cameras(images: np.ndarray, frame: int, look: Look) -> np.ndarray:
    chosen = _chosen(int(images.shape[1]), look)
    pictures = [_rgb(np.asarray(images[frame, k])) for k in chosen]
    return grid(pictures, [f"camera {k}" for k in chosen], look.size)


def _chosen(cameras: int, look: Look) -> Sequence[int]:
    if look.camera is None:
        return range(cameras)
    if not 0 <= look.camera < cameras:
        raise ValueError(f"the camera to show must be 0 .. {cameras - 1}, got {look.camera}")
    return [look.camera]


def _rgb(image: np.ndarray) -> np.ndarray:
    return image if image.ndim == 3 else np.repeat(image[..., None], 3, 2)


def _bytes(image: np.ndarray) -> np.ndarray:
    return np.asarray(np.clip(image + 0.5, 0, 255).astype(np.uint8))
