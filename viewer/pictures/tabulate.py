"""Tables as pictures: figures against targets, or what the fields of a product hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from PIL import Image, ImageDraw

from reperform.nodes.products.table import Table
from reperform.viewer.contents import fields, summary
from reperform.viewer.palette import INK, PANEL, PAPER, RULE, SOFT_INK, STATES, rgb
from reperform.viewer.pictures.canvas import font
from reperform.viewer.pictures.look import Look

HELD = {1: ("✓ held", STATES["fresh"]), 0: ("✗ missed", STATES["failed"]), -1: ("– not measured", SOFT_INK)}


@dataclass(frozen=True)
class Cell:
    """A cell's text, its colour, and whether it is set to the right (numbers)."""

    text: str
    colour: str = INK
    right: bool = False


def table_cells(product: Table) -> tuple[list[str], list[list[Cell]]]:
    """Heads and rows of a table of figures; columns in which nothing stands are left out."""
    columns = {name: np.asarray(getattr(product, name)) for name in Table._fields}
    rows = []
    for k in range(len(columns["figure"])):
        side, target = str(columns["side"][k]), float(columns["target"][k])
        text, colour = HELD[int(columns["holds"][k])] if side else ("", SOFT_INK)
        peer = str(columns["peer"][k])
        rows.append(
            [
                Cell(str(columns["figure"][k])),
                Cell(number(float(columns["value"][k])), right=True),
                Cell(
                    str(columns["unit"][k]).replace("1", "")
                    if columns["unit"][k] == "1"
                    else str(columns["unit"][k])
                ),
                Cell(
                    f"{side} {number(target)}".replace("<=", "≤").replace(">=", "≥") if side else "",
                    right=True,
                ),
                Cell(text, colour),
                Cell(f"{peer} {number(float(columns['peer_value'][k]))}" if peer else "", SOFT_INK),
                Cell(str(columns["source"][k]), SOFT_INK),
            ]
        )
    heads = ["figure", "value", "unit", "target", "", "peer", "source"]
    used = [any(row[c].text for row in rows) or c < 2 for c in range(len(heads))]
    return (
        [head for head, keep in zip(heads, used, strict=True) if keep],
        [[cell for cell, keep in zip(row, used, strict=True) if keep] for row in rows],
    )


def number(value: float) -> str:
    """A figure with four significant digits, without needless zeros or exponents."""
    if np.isnan(value):
        return "–"
    if value == int(value) and abs(value) < 1e7:
        return f"{int(value):,}".replace(",", " ")
    return f"{value:.4g}"


def table_picture(product: Table, frame: int, look: Look) -> np.ndarray:
    """The table with its marks: held, missed, not measured."""
    heads, rows = table_cells(product)
    return draw_table(heads, rows, look.size, look.title)


def statistics_picture(product: Any, frame: int, look: Look) -> np.ndarray:
    """What the fields hold: axes, dtype, unit, and the range of the values of this frame."""
    layout = dict(summary(product))
    rows = []
    for name, (axes, array) in fields(product).items():
        value = np.asarray(array[frame] if "frame" in axes.items else array)
        if value.dtype.kind in "fiub" and value.size:
            finite = value[np.isfinite(value)] if value.dtype.kind == "f" else value
            bounds = [
                number(float(part(finite))) if finite.size else "–" for part in (np.min, np.mean, np.max)
            ]
        else:
            text = ", ".join(map(str, value.ravel()[:4])) + (", …" if value.size > 4 else "")
            bounds = [text[:40], "", ""]
        rows.append(
            [Cell(name), Cell(layout[name], SOFT_INK), *(Cell(bound, right=True) for bound in bounds)]
        )
    title = look.title or f"{type(product).__name__}, frame {frame}"
    return draw_table(["field", "holds", "least", "mean", "greatest"], rows, look.size, title)


def draw_table(
    heads: Sequence[str], rows: Sequence[Sequence[Cell]], size: tuple[int, int], title: str = ""
) -> np.ndarray:
    """A table on a page of this size; the letters shrink until it fits, and long cells are cut."""
    page = Image.new("RGB", size, rgb(PAPER))
    draw = ImageDraw.Draw(page)
    for points in (15, 14, 13, 12, 11, 10, 9, 8):
        face = font(points)
        widths = [
            max([draw.textlength(head, face), *(draw.textlength(row[c].text, face) for row in rows)])
            for c, head in enumerate(heads)
        ]
        tall = round(points * 1.9)
        if sum(widths) + 22 * len(heads) + 24 <= size[0] and tall * (len(rows) + 2) + 40 <= size[1]:
            break
    x0, y = 24, 20
    if title:
        draw.text((x0, y), title, fill=rgb(INK), font=font(points + 3, bold=True))
        y += tall + 8
    bold = font(points, bold=True)
    for k, row in enumerate([[Cell(head, SOFT_INK) for head in heads], *rows]):
        if k and k % 2 == 0:
            draw.rectangle((x0 - 8, y, size[0] - x0 + 8, y + tall), fill=rgb(PANEL))
        x: float = x0
        for c, cell in enumerate(row):
            right = rows[0][c].right if rows else False
            place = (x + widths[c] if right else x, y + tall / 2)
            draw.text(
                place,
                cell.text,
                fill=rgb(cell.colour),
                font=face if k else bold,
                anchor="rm" if right else "lm",
            )
            x += widths[c] + 22
        y += tall
        if k == 0:
            draw.line((x0 - 8, y - 1, size[0] - x0 + 8, y - 1), fill=rgb(RULE))
    return np.asarray(page)
