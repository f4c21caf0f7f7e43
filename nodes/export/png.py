"""Pictures as PNG, alone or many on one sheet."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from reperform.nodes.export.atomic import beside


def write_png(path: Path, image: np.ndarray) -> None:
    """Write an RGB (H, W, 3) or grey (H, W) uint8 picture; complete or absent."""
    if image.dtype != np.uint8 or image.ndim not in (2, 3):
        raise ValueError(
            f"{path}: a picture must be uint8 (H, W) or (H, W, 3), got {image.dtype} {image.shape}"
        )
    bgr = image if image.ndim == 2 else cv2.cvtColor(np.ascontiguousarray(image), cv2.COLOR_RGB2BGR)
    with beside(path) as draft:
        draft.write_bytes(cv2.imencode(".png", bgr)[1].tobytes())


def tile(images: Sequence[np.ndarray], width: int = 1920) -> np.ndarray:
    """Pictures (grey or RGB uint8) side by side in rows, RGB, scaled down so that the sheet is <= `width` px
    wide.

    Columns: the smallest number whose square is no less than the number of pictures. Different sizes are put
    in cells of the largest.
    """
    if not images:
        raise ValueError("a sheet needs at least one picture, got none")
    coloured = [np.repeat(i[..., None], 3, axis=-1) if i.ndim == 2 else i for i in images]
    columns = int(np.ceil(np.sqrt(len(coloured))))
    cell_y, cell_x = (max(i.shape[k] for i in coloured) for k in (0, 1))
    scale = min(1.0, width / (columns * cell_x))
    cell_y, cell_x = max(1, int(cell_y * scale)), max(1, int(cell_x * scale))
    sheet = np.zeros((-(-len(coloured) // columns) * cell_y, columns * cell_x, 3), np.uint8)
    for k, image in enumerate(coloured):
        y, x = k // columns * cell_y, k % columns * cell_x
        size = max(1, int(image.shape[1] * scale)), max(1, int(image.shape[0] * scale))
        small = image if scale == 1 else cv2.resize(image, size, interpolation=cv2.INTER_AREA)
        sheet[y : y + small.shape[0], x : x + small.shape[1]] = small
    return sheet


def heat(values: np.ndarray) -> np.ndarray:
    """Values (H, W) as an RGB picture, from dark blue (smallest) to yellow (largest), 1 px a value; nan is
    grey."""
    finite = np.isfinite(values)
    low, high = (values[finite].min(), values[finite].max()) if finite.any() else (0.0, 1.0)
    level = np.where(finite, (values - low) / max(high - low, 1e-30), 0)
    colours = cv2.applyColorMap(np.rint(255 * level).astype(np.uint8), cv2.COLORMAP_VIRIDIS)[..., ::-1].copy()
    colours[~finite] = 128
    return colours
