"""Grids of targets: how far each was missed, over target distance and target duration; and their table."""

from __future__ import annotations

from typing import Any

import numpy as np

from reperform.nodes.products.key_frame_table import KeyFrameTable
from reperform.nodes.products.target_grid import TargetGrid
from reperform.viewer.palette import ACCENT, PANEL, SOFT_INK
from reperform.viewer.pictures.canvas import figure, pixels
from reperform.viewer.pictures.look import Look
from reperform.viewer.pictures.tabulate import Cell, draw_table, number

COLOURS = "viridis"


def target_grid_picture(product: TargetGrid, frame: int, look: Look) -> np.ndarray:
    """Per key-frame sequence the errors of distance and of duration; grey is proved infeasible, red undecided."""
    status = np.asarray(product.status)
    far = abs(np.asarray(product.reached_distance) - np.asarray(product.distance)[None, :, None])
    late = abs(np.asarray(product.reached_duration) - np.asarray(product.duration)[None, None])
    rows = (("distance error (mm)", 1e3 * far), ("duration error (ms)", 1e3 * late))
    with figure(look.size, "compressed") as fig:
        axes = fig.subplots(len(rows), len(status), squeeze=False, sharex=True, sharey=True)
        for r, (label, errors) in enumerate(rows):
            shown = np.where(status == 1, errors, np.nan)
            top = float(np.nanmax(shown, initial=0.0)) or 1.0
            for s, keys in enumerate(np.asarray(product.keys)):
                drawn = _draw(axes[r, s], product, shown[s], status[s], top)
                if r == 0:
                    axes[r, s].set_title(f"{keys}\n{_share(status[s])}", fontsize=9)
                else:
                    axes[r, s].set_xlabel("target duration (s)")
            axes[r, 0].set_ylabel("target distance (m)")
            fig.colorbar(drawn, ax=axes[r].tolist(), pad=0.01, label=label)
        return pixels(fig)


def _draw(axis: Any, product: TargetGrid, errors: np.ndarray, status: np.ndarray, top: float) -> Any:
    from matplotlib.colors import ListedColormap

    edges = [_edges(np.asarray(targets)) for targets in (product.duration, product.distance)]
    others = np.where(status == 1, np.nan, np.where(status == 0, 0.0, 1.0))
    axis.pcolormesh(*edges, others, cmap=ListedColormap(["#c9d0d6", ACCENT]), vmin=0, vmax=1)
    axis.set_facecolor(PANEL)
    return axis.pcolormesh(*edges, errors, cmap=COLOURS, vmin=0, vmax=top)


def _edges(targets: np.ndarray) -> np.ndarray:
    """The borders of cells around targets that rise evenly."""
    step = float(targets[1] - targets[0]) if len(targets) > 1 else 1.0
    return np.concatenate([targets - step / 2, [targets[-1] + step / 2]])


def _share(status: np.ndarray) -> str:
    met, open_ = float((status == 1).mean()), float((status == -1).mean())
    return f"{100 * met:.0f} % met" + (f", {100 * open_:.1f} % undecided" if open_ else "")


# columns put together: head, fields, whether a share
_COLUMNS: tuple[tuple[str, tuple[str, ...], float], ...] = (
    ("smoothness min max (m)", ("smoothness_min", "smoothness_max"), 1.0),
    ("distance min rms max (m)", ("distance_min", "distance_rms", "distance_max"), 1.0),
    ("time min rms max (s)", ("duration_min", "duration_rms", "duration_max"), 1.0),
    ("distance rms max (%)", ("relative_distance_rms", "relative_distance_max"), 100.0),
    ("time rms max (%)", ("relative_duration_rms", "relative_duration_max"), 100.0),
    ("infeasible (%)", ("infeasible",), 100.0),
    ("undecided (%)", ("undecided",), 100.0),
    ("gap", ("gap",), 1.0),
    ("prepare (s)", ("prepare",), 1.0),
    ("target (ms)", ("target",), 1e3),
)


def key_frame_table_picture(product: KeyFrameTable, frame: int, look: Look) -> np.ndarray:
    """The table, each head naming the numbers of its column; errors are those of the targets that are met."""
    rows = []
    for k, keys in enumerate(np.asarray(product.keys)):
        numbers = (
            "  ".join(_rounded(float(np.asarray(getattr(product, name))[k]) * scale) for name in names)
            for _, names, scale in _COLUMNS
        )
        rows.append(
            [Cell(str(np.asarray(product.character)[k])), Cell(str(keys), SOFT_INK), *map(Cell, numbers)]
        )
    heads = ["character", "key frames", *(head for head, _, _ in _COLUMNS)]
    return draw_table(heads, rows, look.size, look.title)


def _rounded(value: float) -> str:
    return number(float(f"{value:.2g}")) if np.isfinite(value) else "–"
