"""Probability fields, seen as X-rays from front, side and top."""

from __future__ import annotations

import numpy as np

from reperform.nodes.products.mesh import Occupancy
from reperform.viewer.pictures.canvas import figure, pixels
from reperform.viewer.pictures.look import Look


def occupancy_picture(product: Occupancy, frame: int, look: Look) -> np.ndarray:
    """The largest probability along z, x and y, in metres."""
    field = np.asarray(product.probability[frame])
    origin, voxel = np.asarray(product.origin[frame]), float(np.asarray(product.voxel))
    low, high = origin - voxel / 2, origin + voxel * (np.array(field.shape) - 0.5)
    with figure(look.size, "compressed") as fig:
        axes = fig.subplots(1, 3, width_ratios=[max(span, 0.05) for span in (high - low)[[0, 2, 0]]])
        views = (
            ("front (along z)", field.max(2).T, 0, 1),
            ("side (along x)", field.max(0), 2, 1),
            ("top (along y)", field.max(1).T, 0, 2),
        )
        for axis, (title, shown, across, up) in zip(axes, views, strict=True):
            drawn = axis.imshow(
                shown,
                origin="lower",
                extent=(low[across], high[across], low[up], high[up]),
                cmap="bone",
                vmin=0,
                vmax=1,
                interpolation="nearest",
            )
            axis.set(title=title, xlabel=f"{'xyz'[across]} (m)", ylabel=f"{'xyz'[up]} (m)")
        fig.colorbar(drawn, ax=axes, shrink=0.7, pad=0.02, label="probability")
        volume = float((field > 0.5).sum()) * voxel**3
        fig.suptitle(
            f"{' x '.join(map(str, field.shape))} voxels of {1000 * voxel:.1f} mm; "
            f"{volume:.4f} m³ above one half",
            fontsize=10,
        )
        return pixels(fig)
