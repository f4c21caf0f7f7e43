"""Pictures as arrays: drawing text on them, laying them out in a grid, matplotlib figures, PNG."""

from __future__ import annotations

import functools
import importlib.util
import io
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from reperform.viewer.palette import INK, PAPER, RULE, SOFT_INK, rgb

DPI = 100


def png(image: np.ndarray) -> bytes:
    """The PNG file of an RGB uint8 picture (H, W, 3)."""
    buffer = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(image)).save(buffer, "PNG", optimize=False, compress_level=6)
    return buffer.getvalue()


@functools.cache
def font(size: int, bold: bool = False) -> ImageFont.FreeTypeFont:
    """DejaVu Sans, the face that comes with matplotlib, so that pictures are the same on every machine."""
    spec = importlib.util.find_spec("matplotlib")
    folder = Path(spec.origin).parent if spec is not None and spec.origin else Path()
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(str(folder / "mpl-data" / "fonts" / "ttf" / name), size)


def fit(image: np.ndarray, width: int, height: int) -> np.ndarray:
    """The picture scaled to fit into width x height, its proportions kept; area-averaged where it shrinks."""
    import cv2

    scale = min(width / image.shape[1], height / image.shape[0])
    size = (max(1, round(image.shape[1] * scale)), max(1, round(image.shape[0] * scale)))
    how = cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC if scale < 3 else cv2.INTER_NEAREST
    return np.asarray(cv2.resize(np.ascontiguousarray(image), size, interpolation=how))


def on_page(image: np.ndarray, size: tuple[int, int], paper: str = PAPER) -> np.ndarray:
    """The picture in the middle of a page of exactly this size (width, height)."""
    page = np.empty((size[1], size[0], 3), np.uint8)
    page[:] = rgb(paper)
    small = fit(image, *size)
    y, x = (size[1] - small.shape[0]) // 2, (size[0] - small.shape[1]) // 2
    page[y : y + small.shape[0], x : x + small.shape[1]] = small
    return page


def grid(
    images: Sequence[np.ndarray], labels: Sequence[str], size: tuple[int, int], paper: str = PAPER
) -> np.ndarray:
    """Labelled pictures side by side on a page of this size, in the columns that show them largest."""
    page = Image.new("RGB", size, rgb(paper))
    if not images:
        return np.asarray(page)
    gap, strip = 8, 20
    columns = _columns(images, size, gap, strip)
    rows = math.ceil(len(images) / columns)
    width = (size[0] - gap * (columns + 1)) // columns
    height = (size[1] - gap * (rows + 1)) // rows - strip
    small = [fit(image, max(width, 1), max(height, 1)) for image in images]
    tall = max(image.shape[0] for image in small) + strip
    top = max(gap, (size[1] - rows * tall - gap * (rows - 1)) // 2)
    draw = ImageDraw.Draw(page)
    for k, (image, label) in enumerate(zip(small, labels, strict=True)):
        x = gap + (k % columns) * (width + gap) + (width - image.shape[1]) // 2
        y = top + (k // columns) * (tall + gap)
        draw.text((x + 1, y + 2), label, fill=rgb(SOFT_INK), font=font(12))
        page.paste(Image.fromarray(image), (x, y + strip))
        draw.rectangle(
            (x - 1, y + strip - 1, x + image.shape[1], y + strip + image.shape[0]), outline=rgb(RULE)
        )
    return np.asarray(page)


def _columns(images: Sequence[np.ndarray], size: tuple[int, int], gap: int, strip: int) -> int:
    def scale(columns: int) -> float:
        rows = math.ceil(len(images) / columns)
        width = (size[0] - gap * (columns + 1)) / columns
        height = (size[1] - gap * (rows + 1)) / rows - strip
        return min(min(width / image.shape[1], height / image.shape[0]) for image in images)

    return max(range(1, len(images) + 1), key=scale)


def write_text(
    image: np.ndarray,
    text: str,
    at: tuple[float, float],
    size: int = 13,
    colour: str = INK,
    anchor: str = "la",
) -> np.ndarray:
    """The picture with text on it at (x, y); anchor as in Pillow (`la` = left, top)."""
    page = Image.fromarray(image)
    ImageDraw.Draw(page).text(at, text, fill=rgb(colour), font=font(size), anchor=anchor)
    return np.array(page)


@contextmanager
def figure(
    size: tuple[int, int], layout: Literal["constrained", "compressed"] = "constrained"
) -> Iterator[Any]:
    """A matplotlib figure of width x height pixels in the house style; `pixels(fig)` reads it.

    layout: matplotlib's; `compressed` where axes have an aspect of their own.
    """
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    style = {
        "font.family": "DejaVu Sans",
        "font.size": 9.5,
        "axes.edgecolor": SOFT_INK,
        "axes.labelcolor": INK,
        "axes.titlecolor": INK,
        "axes.titlesize": 11,
        "axes.linewidth": 0.8,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "text.color": INK,
        "xtick.color": SOFT_INK,
        "ytick.color": SOFT_INK,
        "grid.color": RULE,
        "legend.frameon": False,
        "figure.facecolor": PAPER,
        "savefig.facecolor": PAPER,
    }
    with matplotlib.rc_context(style):
        # On a small page everything is drawn smaller, so that it still fits.
        dpi = DPI * min(1.0, size[0] / 480, size[1] / 360)
        inches = ((size[0] + 0.01) / dpi, (size[1] + 0.01) / dpi)
        fig: Any = Figure(figsize=inches, dpi=dpi, layout=layout)
        fig.get_layout_engine().set(w_pad=0.14, h_pad=0.14)
        FigureCanvasAgg(fig)
        yield fig


def pixels(fig: Any) -> np.ndarray:
    """The RGB picture of a figure."""
    fig.canvas.draw()
    return np.asarray(fig.canvas.buffer_rgba())[..., :3].copy()
