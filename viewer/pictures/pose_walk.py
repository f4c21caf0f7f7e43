"""Walks through a pose graph: the way over the ground beside the one wanted, and which captured moment plays when."""

from __future__ import annotations

import numpy as np

from reperform.nodes.products.motion import Provenance
from reperform.nodes.products.pose_walk import PoseWalk
from reperform.viewer.palette import INK, SOFT_INK
from reperform.viewer.pictures.canvas import figure, pixels
from reperform.viewer.pictures.look import Look
from reperform.viewer.pictures.motion_path import draw_sources, draw_track


def pose_walk_picture(product: PoseWalk, frame: int, look: Look) -> np.ndarray:
    """Above the body's track and, dotted, the curve it was to follow; below the captured moments over time."""
    source = Provenance(
        np.asarray(product.takes),
        np.asarray(product.take),
        np.asarray(product.time),
        np.asarray(product.weight),
        np.asarray(product.yaw),
        np.asarray(product.offset),
    )
    track, wanted = np.asarray(product.middle)[:, [0, 2]], np.asarray(product.wanted)[:, [0, 2]]
    rate = float(np.asarray(product.fps)) or 25.0
    with figure(look.size) as fig:
        above, below = fig.subplots(2, 1, height_ratios=[1, 1])
        if np.isfinite(wanted).any():
            above.plot(wanted[:, 0], wanted[:, 1], ":", color=SOFT_INK, linewidth=2, label="wanted", zorder=4)
        draw_track(above, track, source, frame)
        draw_sources(below, source, frame, rate)
        for shown, asked in zip(np.asarray(product.shown), np.asarray(product.asked), strict=True):
            below.axvline(shown / rate, color=INK, linewidth=0.8)
            if np.isfinite(asked):
                below.axvline(asked / rate, color=INK, linewidth=0.8, linestyle=":")
        fig.suptitle(_promise(product, track, wanted), fontsize=10, color=INK)
        return pixels(fig)


def _promise(product: PoseWalk, track: np.ndarray, wanted: np.ndarray) -> str:
    cost, bound = float(np.asarray(product.cost)), float(np.asarray(product.bound))
    text = f"{len(track) / (float(np.asarray(product.fps)) or 25.0):.2f} s; cost {cost:.4g}"
    if np.isfinite(wanted).all():
        off = np.sqrt(np.square(track - wanted).sum(axis=1).mean())
        return f"{text}; {off:.3f} m off the curve (root mean square)"
    return f"{text}, at most {cost - bound:.3g} above the best"
