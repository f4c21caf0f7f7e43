"""The viewer's window as a picture, drawn without a window."""

from __future__ import annotations

from typing import Any

import numpy as np
from PIL import Image, ImageDraw

from reperform.viewer.palette import ACCENT, INK, PANEL, PAPER, RULE, SOFT_INK, rgb, state_colour, tint
from reperform.viewer.pictures.canvas import font
from reperform.viewer.session import Session

PANEL_WIDTH, TIMELINE, ROW = 232, 54, 22


def screenshot(session: Session, size: tuple[int, int] = (1280, 800)) -> np.ndarray:
    """What the window shows: steps and items, the chosen frame, the timeline; RGB uint8 (H, W, 3)."""
    width, height = size
    page = Image.new("RGB", size, rgb(PAPER))
    main = session.picture((width - PANEL_WIDTH, height - TIMELINE))
    page.paste(Image.fromarray(main), (PANEL_WIDTH, 0))
    draw = ImageDraw.Draw(page)
    draw.rectangle((0, 0, PANEL_WIDTH - 1, height), fill=rgb(PANEL))
    _draw_steps(draw, session, height)
    draw.line((PANEL_WIDTH - 1, 0, PANEL_WIDTH - 1, height), fill=rgb(RULE))
    _draw_timeline(draw, session, width, height)
    return np.asarray(page)


def _draw_steps(draw: Any, session: Session, height: int) -> None:
    y = 14
    draw.text((16, y), session.browser.title or "reperform", fill=rgb(INK), font=font(15, bold=True))
    y += 32
    details = session.details()
    room = height - 24 - (34 + 30 * len(details) if details else 0)
    entries = _entries(session, max(4, (room - y) // ROW))
    for step, text, chosen, state in entries:
        if chosen:
            draw.rounded_rectangle((8, y - 2, PANEL_WIDTH - 10, y + ROW - 4), 4, fill=rgb(tint(ACCENT, 0.82)))
        if step:
            draw.ellipse((17, y + 5, 24, y + 12), fill=rgb(state_colour(state)))
        draw.text(
            (32 if step else 46, y + 1), _cut(draw, text, PANEL_WIDTH - 56, 12), fill=rgb(INK), font=font(12)
        )
        y += ROW
    if details:
        y = height - 10 - 30 * len(details) - 24
        if y < 46 + ROW * len(entries):
            return
        draw.text((16, y), type(session.product).__name__, fill=rgb(SOFT_INK), font=font(11, bold=True))
        y += 21
        for name, holds in details:
            draw.text((16, y), _cut(draw, name, PANEL_WIDTH - 30, 11), fill=rgb(INK), font=font(11))
            draw.text(
                (16, y + 13), _cut(draw, holds, PANEL_WIDTH - 30, 10), fill=rgb(SOFT_INK), font=font(10)
            )
            y += 30


def _entries(session: Session, most: int) -> list[tuple[bool, str, bool, str]]:
    """(is a step, text, chosen, state) of the rows of the tree; rows far from the chosen one are left out."""
    rows: list[tuple[bool, str, bool, str]] = []
    for step in session.browser.steps():
        items = [item for item in session.items(step) if item]
        here = step == session.step
        rows.append((True, step, here and not items, session.browser.status(step)))
        if here:
            rows += [(False, item, item == session.item, "") for item in items]
    if len(rows) <= most:
        return rows
    at = next((k for k, row in enumerate(rows) if row[2]), 0)
    first = min(max(0, at - most // 2), len(rows) - most)
    return rows[first : first + most]


def _cut(draw: Any, text: str, width: float, points: int) -> str:
    face = font(points)
    if draw.textlength(text, face) <= width:
        return text
    while text and draw.textlength(text + "…", face) > width:
        text = text[:-1]
    return text + "…"


def _draw_timeline(draw: Any, session: Session, width: int, height: int) -> None:
    top = height - TIMELINE
    draw.rectangle((PANEL_WIDTH, top, width, height), fill=rgb(PANEL))
    draw.line((PANEL_WIDTH, top, width, top), fill=rgb(RULE))
    left, right, y = PANEL_WIDTH + 56, width - 20, top + 17
    x = PANEL_WIDTH + 22
    if session.playing:
        draw.rectangle((x, y - 7, x + 4, y + 7), fill=rgb(INK))
        draw.rectangle((x + 8, y - 7, x + 12, y + 7), fill=rgb(INK))
    else:
        draw.polygon([(x, y - 8), (x + 13, y), (x, y + 8)], fill=rgb(INK if session.frames > 1 else RULE))
    share = session.frame / max(session.frames - 1, 1)
    at = left + share * (right - left)
    draw.rounded_rectangle((left, y - 2, right, y + 2), 2, fill=rgb(RULE))
    if session.frames > 1:
        draw.rounded_rectangle((left, y - 2, max(at, left + 4), y + 2), 2, fill=rgb(ACCENT))
        draw.ellipse((at - 7, y - 7, at + 7, y + 7), fill=rgb(ACCENT), outline=rgb(PAPER))
    draw.text((left, y + 13), session.caption(), fill=rgb(SOFT_INK), font=font(12))
