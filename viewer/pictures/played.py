"""Played motion: the way over the ground by what plays, and parameters asked against parameters played."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from reperform.nodes.products.played import Played
from reperform.viewer.palette import ACCENT, INK, PAPER, RULE, SOFT_INK, STATIONS, tint
from reperform.viewer.pictures.canvas import figure, pixels
from reperform.viewer.pictures.look import Look

# neighbours in the list differ in hue; without the grey one, which looks like the first
_HUES = [colour for name, colour in STATIONS.items() if name != "evaluate"]
_COLOURS = [_HUES[5 * k % len(_HUES)] for k in range(len(_HUES))]
# a parameter's axis shows at least this share of its greatest value
_SPAN = 0.1


def played_picture(product: Played, frame: int, look: Look) -> np.ndarray:
    """Left the track of the root in the colours of the spaces; right each parameter over time, dashed as asked."""
    rate = float(np.asarray(product.mesh.fps)) or 25.0
    shown = np.flatnonzero(~np.isnan(np.asarray(product.done)).all(axis=0))
    with figure(look.size) as fig:
        wide = look.size[0] >= 1.2 * look.size[1]
        left, right = fig.subfigures(1, 2, width_ratios=[1, 1.5]) if wide else fig.subfigures(2, 1)
        _track(left.subplots(), product, frame, wide)
        rows = right.subplots(max(len(shown), 1), 1, sharex=True, squeeze=False)[:, 0]
        for axis, k in itertools.zip_longest(rows, shown.tolist()):
            _bands(axis, product, rate)
            if k is not None:
                _parameter(axis, product, k, rate)
            axis.axvline(frame / rate, color=ACCENT, linewidth=1.2)
            axis.margins(x=0)
        rows[0].set_title(
            "dashed: asked; line: played; lines down: requests", loc="left", fontsize=9, color=SOFT_INK
        )
        rows[-1].set_xlabel("time (s)")
        return pixels(fig)


def _runs(space: np.ndarray) -> list[tuple[int, int, int]]:
    """(first frame, one past the last, space) of each stretch in which one space plays."""
    cuts = [0, *(np.flatnonzero(np.diff(space)) + 1).tolist(), len(space)]
    return [(a, b, int(space[a])) for a, b in itertools.pairwise(cuts) if b > a]


def _track(axis: Any, product: Played, frame: int, wide: bool) -> None:
    root, way = np.asarray(product.root)[:, :2], np.asarray(product.way)
    names = np.asarray(product.spaces).tolist()
    if len(way):
        axis.plot(way[:, 0], way[:, 1], color=SOFT_INK, linestyle=":", linewidth=1.2, label="the way given")
    known: set[int] = set()
    for a, b, space in _runs(np.asarray(product.space)):
        part = root[a : min(b + 1, len(root))]
        label = None if space in known else names[space].replace("_", " ")
        known.add(space)
        axis.plot(*part.T, color=_colour(space), linewidth=3, label=label, solid_capstyle="round")
    for k, name in ((0, "start"), (len(root) - 1, "end")):
        axis.plot(*root[k], "o", color=INK, markersize=5)
        axis.annotate(name, root[k], xytext=(7, 4), textcoords="offset points", fontsize=8.5)
    axis.plot(*root[frame], "o", color=ACCENT, markeredgecolor=PAPER, markersize=9)
    axis.grid(True, linewidth=0.5)
    axis.set_axisbelow(True)
    axis.margins(0.15)
    axis.set(xlabel="x (m)", ylabel="z (m)")
    axis.set_aspect("equal", adjustable="datalim")
    axis.set_title("track of the root, by what plays", loc="left", fontsize=9, color=SOFT_INK)
    # seen from above, as the actor turns: left of +z is +x
    axis.invert_xaxis()
    if wide:
        axis.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=3, fontsize=8)
    else:
        axis.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8)


def _bands(axis: Any, product: Played, rate: float) -> None:
    for a, b, space in _runs(np.asarray(product.space)):
        axis.axvspan(a / rate, b / rate, color=tint(_colour(space), 0.72), lw=0)
    for time in np.asarray(product.request_time).tolist():
        axis.axvline(time, color=SOFT_INK, linewidth=0.7)


def _parameter(axis: Any, product: Played, k: int, rate: float) -> None:
    name, unit = str(np.asarray(product.parameters)[k]), str(np.asarray(product.units)[k])
    asked, done = np.asarray(product.asked)[:, k], np.asarray(product.done)[:, k]
    time = np.arange(len(done)) / rate
    axis.plot(time, asked, color=INK, linestyle="--", linewidth=1.1)
    axis.plot(time, done, color=INK, linewidth=1.8)
    axis.margins(y=0.15)
    low, high = axis.get_ylim()
    least = _SPAN * max(abs(low), abs(high))
    if high - low < least:
        axis.set_ylim(0.5 * (low + high - least), 0.5 * (low + high + least))
    axis.ticklabel_format(axis="y", useOffset=False, style="plain")
    axis.set_ylabel(f"{name.replace('_', ' ')}\n({unit})", fontsize=8.5)
    axis.tick_params(labelsize=8)
    axis.grid(True, axis="y", color=RULE, linewidth=0.5)


def _colour(space: int) -> str:
    return _COLOURS[space % len(_COLOURS)]
