"""The state of a directed character as two diagrams: which motion plays, and under which parameters."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from PIL import Image, ImageDraw

from reperform.viewer.palette import ACCENT, INK, PAPER, RULE, SOFT_INK, STATES, rgb, tint
from reperform.viewer.pictures.canvas import font

_ACTIVE = STATES["fresh"]
_WAITED = STATES["stale"]


def node_diagram(
    names: Sequence[str],
    edges: Sequence[tuple[int, int]],
    active: int,
    wanted: int,
    share: float,
    size: tuple[int, int],
) -> np.ndarray:
    """Spaces on a circle, joined where one may follow the other: RGB uint8 of this size (width, height).

    active: the space that plays, green; wanted: the one asked for, amber; share: how far along a motion is, 0 .. 1,
    drawn as a bar under its name.

    Source: 004 fig B.3a.
    """
    page = Image.new("RGB", size, rgb(PAPER))
    draw = ImageDraw.Draw(page)
    width, height = size
    letters = font(max(9, min(13, round(height / 18))))
    boxes = [draw.textlength(name, font=letters) / 2 + 8 for name in names]
    half = letters.size * 0.5 + 6
    across, down = width / 2 - max(boxes) - 6, height / 2 - half - 6
    turn = [2 * math.pi * k / len(names) - math.pi / 2 for k in range(len(names))]
    places = [(width / 2 + across * math.cos(a), height / 2 + down * math.sin(a)) for a in turn]
    for a, b in edges:
        if a != b:
            lit = a == active
            draw.line(
                (*places[a], *places[b]),
                fill=rgb(tint(_ACTIVE, 0.35) if lit else RULE),
                width=2 if lit else 1,
            )
    for k, (name, (x, y), box) in enumerate(zip(names, places, boxes, strict=True)):
        colour = _ACTIVE if k == active else _WAITED if k == wanted else "#eef1f4"
        draw.rounded_rectangle(
            (x - box, y - half, x + box, y + half), 6, fill=rgb(tint(colour, 0.25) if k in (active, wanted) else colour),
            outline=rgb(colour if k in (active, wanted) else RULE), width=2 if k in (active, wanted) else 1,
        )  # fmt: skip
        draw.text((x, y), name, fill=rgb(INK), font=letters, anchor="mm")
        if k == active:
            end = x - box + 4 + (2 * box - 8) * min(max(share, 0.0), 1.0)
            draw.line((x - box + 4, y + half - 3, end, y + half - 3), fill=rgb(_ACTIVE), width=3)
    return np.asarray(page)


def parameter_diagram(
    names: Sequence[str],
    units: Sequence[str],
    lower: np.ndarray,
    upper: np.ndarray,
    asked: np.ndarray,
    before: np.ndarray,
    size: tuple[int, int],
) -> np.ndarray:
    """One scale per parameter from its least to its greatest value: RGB uint8 of this size (width, height).

    Red: what is asked now; yellow: what was asked before.

    Source: 004 fig B.3b.
    """
    page = Image.new("RGB", size, rgb(PAPER))
    draw = ImageDraw.Draw(page)
    width, height = size
    letters = font(max(9, min(13, round(height / 12))))
    row = height / max(len(names), 1)
    for k, name in enumerate(names):
        top = k * row + 0.5 * row
        left, right = 14, width - 14
        draw.text((left, top - 8), f"{name}, {units[k]}", fill=rgb(INK), font=letters, anchor="ld")
        draw.text((right, top - 8), f"{asked[k]:.2f}", fill=rgb(ACCENT), font=letters, anchor="rd")
        draw.line((left, top, right, top), fill=rgb(RULE), width=5)
        for value, colour in ((before[k], STATES["stale"]), (asked[k], ACCENT)):
            share = (value - lower[k]) / max(upper[k] - lower[k], 1e-9)
            x = left + (right - left) * min(max(share, 0.0), 1.0)
            draw.line((x, top - 7, x, top + 7), fill=rgb(colour), width=4)
        draw.text((left, top + 8), f"{lower[k]:.2f}", fill=rgb(SOFT_INK), font=letters, anchor="la")
        draw.text((right, top + 8), f"{upper[k]:.2f}", fill=rgb(SOFT_INK), font=letters, anchor="ra")
    return np.asarray(page)
