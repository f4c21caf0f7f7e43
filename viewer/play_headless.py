"""Playing by script without a window: the same session, drawn without a display."""

from __future__ import annotations

import numpy as np

from reperform.viewer.palette import INK, PANEL, rgb
from reperform.viewer.pictures.canvas import write_text
from reperform.viewer.pictures.look import View
from reperform.viewer.pictures.scene import Body, Line, draw_scene
from reperform.viewer.play_script_input import ScriptedInput
from reperform.viewer.play_session import HELP, RATE, PlaySession


def play_scripted(session: PlaySession, scripted: ScriptedInput, seconds: float) -> None:
    """Let so much time pass, doing what the script says; as fast as it can."""
    for frame in range(round(seconds * RATE)):
        scripted.due(session, frame / RATE)
        session.tick(1 / RATE)


def play_picture(session: PlaySession, size: tuple[int, int] = (1280, 800)) -> np.ndarray:
    """What the window shows: the character, its diagrams and the status line; RGB uint8 (height, width, 3)."""
    width, height = size
    panel, bar = round(0.3 * width), 56
    page = np.empty((height, width, 3), np.uint8)
    page[:] = rgb(PANEL)
    high = height - bar
    page[:high, : width - panel] = _scene(session, (width - panel, high))
    split = round(0.6 * high)
    page[:split, width - panel :] = session.nodes_picture((panel, split))
    page[split:high, width - panel :] = session.parameters_picture((panel, high - split))
    page = write_text(page, session.status(), (10, high + 8), 14, INK)
    return write_text(page, HELP, (10, high + 32), 12, INK)


def _scene(session: PlaySession, size: tuple[int, int]) -> np.ndarray:
    character = session.character
    x, z = character.root[:2]
    view = View(azimuth=2.6, elevation=0.3, target=(float(x), 0.95, float(z)), distance=5.0)
    body = Body(character.vertices, session.data.faces)
    lines = []
    if len(session.path) > 1:
        path = np.array(session.path)
        lines.append(
            Line(np.column_stack([path[:, 0], np.full(len(path), 0.01), path[:, 1]]), (0.82, 0.29, 0.36), 3.0)
        )
    return draw_scene([body], view, size, lines)
