"""Parametric spaces: what each mixture does, and takes in step; warps of one take onto another."""

from __future__ import annotations

from typing import Any

import numpy as np

from reperform.nodes.products.parametric import ParametricSpace, TimeWarp
from reperform.viewer.palette import ACCENT, INK, RULE, SOFT_INK
from reperform.viewer.pictures.canvas import figure, pixels
from reperform.viewer.pictures.look import Look
from reperform.viewer.pictures.motion_graph import take_colour


def parametric_space_picture(product: ParametricSpace, frame: int, look: Look) -> np.ndarray:
    """Left: the map from weights to parameters; right: which captured moment each pose shows, and planted feet."""
    takes = np.asarray(product.takes).tolist()
    fps = float(np.asarray(product.fps))
    with figure(look.size) as fig:
        left, right = fig.subplots(1, 2)
        _map(left, product, takes)
        shown, planted = np.asarray(product.source_frame), np.asarray(product.planted)
        poses = np.arange(shown.shape[1])
        for k, take in enumerate(takes):
            own = (shown[k] - shown[k, 0]) / fps
            right.plot(poses, own, color=take_colour(k), linewidth=1.8, label=take)
            for foot, marker in ((0, "v"), (1, "^")):
                held = planted[k, :, foot]
                right.plot(
                    poses[held],
                    own[held],
                    linestyle="none",
                    marker=marker,
                    markersize=4,
                    color=take_colour(k),
                )
        kind = "a cycle" if bool(np.asarray(product.cyclic)) else "once"
        right.set(
            xlabel=f"pose ({kind})",
            ylabel="seconds into the take",
            title="in step: feet down are left ▾, right ▴",
        )
        right.grid(color=RULE)
        right.legend(loc="upper left")
        if look.title:
            fig.suptitle(look.title)
        return pixels(fig)


def _map(axis: Any, product: ParametricSpace, takes: list[str]) -> None:
    names = [f"{name} ({unit})" for name, unit in zip(product.parameters, product.units, strict=True)]
    value, sampled = np.asarray(product.value), np.asarray(product.sample_value)
    error = np.asarray(product.inverse_error)
    said = ", ".join(f"{100 * worst:.2f} %" for worst in error[:, 1])
    if value.shape[1] == 1:
        control = np.asarray(product.sample_weight) @ np.asarray(product.control)
        order = np.argsort(control[:, 0])
        axis.plot(control[order, 0], sampled[order, 0], color=SOFT_INK, marker=".", markersize=4, linewidth=1)
        place = np.asarray(product.control)[:, 0], value[:, 0]
        axis.set(xlabel="weights (0 lowest input, 1 highest)", ylabel=names[0])
    else:
        axis.scatter(sampled[:, 0], sampled[:, 1], s=5, color=SOFT_INK, linewidth=0)
        for cell in np.asarray(product.cells):
            ring = value[[*cell, cell[0]]]
            axis.plot(ring[:, 0], ring[:, 1], color=RULE, linewidth=1, zorder=0)
        place = value[:, 0], value[:, 1]
        axis.set(xlabel=names[0], ylabel=names[1])
    for k, take in enumerate(takes):
        axis.plot(place[0][k], place[1][k], "o", color=take_colour(k), markersize=8, markeredgecolor=INK)
        axis.annotate(take, (place[0][k], place[1][k]), xytext=(9, -14), textcoords="offset points")
    axis.margins(0.16)
    axis.grid(color=RULE)
    axis.set_title(f"what a blend does; inverse within {said} of range")


def time_warp_picture(product: TimeWarp, frame: int, look: Look) -> np.ndarray:
    """The moment of the second take for every frame of the first, beside the straight line."""
    other = np.asarray(product.other)
    a, b = look.pair or ("first take", "second take")
    with figure(look.size) as fig:
        axis = fig.subplots()
        axis.plot([0, len(other) - 1], [other[0], other[-1]], color=RULE, linewidth=1.5)
        axis.plot(np.arange(len(other)), other, color=ACCENT, marker=".", linewidth=1.5)
        axis.grid(color=RULE)
        cost = float(np.asarray(product.cost))
        axis.set(xlabel=f"frame of {a}", ylabel=f"frame of {b}", title=f"mean dissimilarity {cost:.3f}")
        return pixels(fig)
