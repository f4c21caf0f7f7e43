"""Motion paths: the way over the ground, and which captured frame plays when."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from reperform.nodes.products.motion import MotionPath, Provenance
from reperform.viewer.palette import ACCENT, INK, PAPER, SOFT_INK
from reperform.viewer.pictures.canvas import figure, pixels
from reperform.viewer.pictures.look import Look
from reperform.viewer.pictures.motion_graph import take_colour


def motion_path_picture(product: MotionPath, frame: int, look: Look) -> np.ndarray:
    """Above the ground track (where the takes' own tracks are known), below the captured frame over time."""
    source = product.provenance
    track = ground_track(source, look.tracks) if look.tracks is not None else None
    with figure(look.size) as fig:
        if track is None:
            below = fig.subplots()
        else:
            above, below = fig.subplots(2, 1, height_ratios=[1, 1])
            draw_track(above, track, source, frame)
        rate = float(np.asarray(product.fps)) or 25.0
        draw_sources(below, source, frame, rate)
        fig.suptitle(_promise(product), fontsize=10, color=INK)
        return pixels(fig)


def ground_track(source: Provenance, tracks: Any) -> np.ndarray | None:
    """Ground position (frames, 2) in metres (x, z) of every synthesised frame; None where a track lacks.

    Each source's captured centroid is placed by x_world = R_y(yaw) x + (offset_x, 0, offset_z), then blended.
    """
    takes = np.asarray(source.takes).tolist()
    if any(take not in tracks for take in takes):
        return None
    take, index = np.asarray(source.take), np.asarray(source.source_frame)
    weight, yaw = (np.asarray(part, np.float64) for part in (source.weight, source.yaw))
    offset = np.asarray(source.offset, np.float64)
    placed = np.zeros((len(take), 2))
    for k in (0, 1):
        here = np.zeros((len(take), 3))
        for j, name in enumerate(takes):
            own = (take[:, k] == j) & (weight[:, k] > 0)
            here[own] = np.asarray(tracks[name])[index[own, k]]
        cos, sin = np.cos(yaw[:, k]), np.sin(yaw[:, k])
        world = np.stack([cos * here[:, 0] + sin * here[:, 2], -sin * here[:, 0] + cos * here[:, 2]], 1)
        placed += weight[:, k : k + 1] * (world + offset[:, k])
    return placed


def _runs(source: Provenance) -> list[tuple[int, int, int]]:
    """(first frame, one past the last, take) of each stretch in which one take weighs most."""
    weight, take = np.asarray(source.weight), np.asarray(source.take)
    main = take[np.arange(len(take)), weight.argmax(1)] if len(take) else np.zeros(0, int)
    cuts = [0, *(np.flatnonzero(np.diff(main)) + 1).tolist(), len(main)]
    return [(a, b, int(main[a])) for a, b in itertools.pairwise(cuts) if b > a]


def draw_track(axis: Any, track: np.ndarray, source: Provenance, frame: int) -> None:
    """The ground track (frames, 2), m, each stretch in the colour of the take that weighs most in it."""
    names = np.asarray(source.takes).tolist()
    known: set[int] = set()
    for a, b, take in _runs(source):
        part = track[a : min(b + 1, len(track))]
        label = names[take] if take not in known else None
        known.add(take)
        axis.plot(
            part[:, 0],
            part[:, 1],
            color=take_colour(take),
            linewidth=3.2,
            label=label,
            solid_capstyle="round",
        )
    for k, name in ((0, "start"), (len(track) - 1, "end")):
        axis.plot(*track[k], "o", color=INK, markersize=6)
        axis.annotate(name, track[k], xytext=(7, 7), textcoords="offset points", fontsize=8.5)
    if 0 <= frame < len(track):
        axis.plot(*track[frame], "o", color=ACCENT, markeredgecolor=PAPER, markersize=9)
    axis.grid(True, linewidth=0.5)
    axis.set_axisbelow(True)
    axis.margins(0.15)
    axis.set(aspect="equal", xlabel="x (m)", ylabel="z (m)")
    axis.set_title("ground track of the centroid", loc="left", fontsize=9.5, color=SOFT_INK)
    axis.invert_yaxis()
    axis.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8.5)


def draw_sources(axis: Any, source: Provenance, frame: int, rate: float) -> None:
    """Which captured frame of which take plays when; shaded where two are blended."""
    take, index = np.asarray(source.take), np.asarray(source.source_frame)
    weight, names = np.asarray(source.weight), np.asarray(source.takes).tolist()
    time = np.arange(len(take)) / rate
    blended = weight.min(1) > 1e-6 if len(weight) else np.zeros(0, bool)
    for a, b in _stretches(blended):
        axis.axvspan(time[a] - 0.5 / rate, time[b - 1] + 0.5 / rate, color=ACCENT, alpha=0.12, lw=0)
    for k in (0, 1):
        for j in range(len(names)):
            own = (take[:, k] == j) & (weight[:, k] > 1e-6)
            if own.any():
                sizes = 4 + 16 * weight[own, k]
                axis.scatter(time[own], index[own, k], s=sizes, color=take_colour(j), lw=0)
    for a, b, j in _runs(source):
        middle = (a + b) // 2
        main = int(weight[middle].argmax())
        axis.annotate(
            names[j].replace("_", " "),
            (time[middle], index[middle, main]),
            xytext=(0, 9),
            textcoords="offset points",
            ha="center",
            fontsize=8.5,
            color=take_colour(j),
        )
    if 0 <= frame < len(time):
        axis.axvline(time[frame], color=ACCENT, linewidth=1.2)
    axis.margins(0.03, 0.14)
    axis.set(xlabel="time (s)", ylabel="captured frame")
    axis.set_title(
        "captured frame played; shaded where two are blended", loc="left", fontsize=9.5, color=SOFT_INK
    )


def _stretches(mask: np.ndarray) -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(int)))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


def _promise(product: MotionPath) -> str:
    def pair(values: Any, unit: str) -> str:
        reached, asked = np.asarray(values, np.float64)
        return f"{reached:.2f} {unit}" + (f" (asked {asked:.2f})" if np.isfinite(asked) else "")

    cost, bound = float(np.asarray(product.cost)), float(np.asarray(product.bound))
    gap = f", at most {cost - bound:.3g} above the best" if np.isfinite(bound) else ""
    return f"{pair(product.distance, 'm')} in {pair(product.duration, 's')}; cost {cost:.4g}{gap}"
