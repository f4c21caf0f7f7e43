"""The play window: a character under the keyboard, its diagrams beside it."""

from __future__ import annotations

import gc
import time
from pathlib import Path
from typing import Any

import numpy as np

from reperform.viewer.pictures.scene import Body
from reperform.viewer.play_script_input import ScriptedInput
from reperform.viewer.play_session import HELP, PlaySession
from reperform.viewer.stage import GRID, set_stage
from reperform.viewer.window import SIZE, as_image, as_mesh, check_display

_PANEL, _BAR = 380, 56
_BODY, _PATH = "body", "path"
# places shown of a drawn path: lines in a scene must not change in number
_DOTS = 64


def play_window(
    session: PlaySession, title: str, scripted: ScriptedInput | None = None, seconds: float = 0.0,
    picture: Path | None = None, size: tuple[int, int] = SIZE,
) -> None:  # fmt: skip
    """Play until the window is closed.

    scripted: keys pressed at given times.  seconds: close by itself after so long; 0: never.  picture: a file that gets
    a picture of the scene just before it closes. Raises NoDisplayError without a display.
    """
    check_display()
    from open3d.visualization import gui

    app = gui.Application.instance
    app.initialize()
    shown = PlayWindow(session, app.create_window(title, *size), scripted, seconds, picture)
    app.run()
    shown.__dict__.clear()
    gc.collect()


class PlayWindow:
    """Widgets around a play session."""

    def __init__(
        self,
        session: PlaySession,
        window: Any,
        scripted: ScriptedInput | None,
        seconds: float,
        picture: Path | None,
    ) -> None:
        from open3d.visualization import gui, rendering

        self.session, self.window, self.scripted = session, window, scripted
        self._gui: Any = gui
        self._rendering: Any = rendering
        self._end, self._picture = seconds, picture
        self._last = self._start = time.monotonic()
        self._drawn, self._closing = 0.0, False
        self._down: set[str] = set()
        self._room = 1 << (len(session.data.faces) - 1).bit_length()
        self._keys = {
            gui.KeyName.UP: "up", gui.KeyName.DOWN: "down", gui.KeyName.LEFT: "left", gui.KeyName.RIGHT: "right",
        }  # fmt: skip
        self._keys |= {getattr(gui.KeyName, letter.upper()): letter for letter in "jlrghxc"}
        words = ("ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")
        self._keys |= {getattr(gui.KeyName, word): str(k + 1) for k, word in enumerate(words)}
        self._build()

    def _build(self) -> None:
        gui, rendering = self._gui, self._rendering
        self._scene = set_stage(self.window, 6.0, 40.0)
        scene = self._scene.scene
        scene.view.set_antialiasing(False)
        self._material = rendering.MaterialRecord()
        self._material.shader = "defaultLit"
        self._material.base_roughness, self._material.base_reflectance = 0.9, 0.2
        up, eye = np.array([0, 1, 0], np.float32), np.array([2.6, 2.2, -4.6], np.float32)
        self._scene.look_at(np.array([0, 0.9, 0], np.float32), eye, up)
        self._dot = rendering.MaterialRecord()
        self._dot.shader, self._dot.point_size = "defaultUnlit", 9.0
        self._nodes, self._parameters = gui.ImageWidget(), gui.ImageWidget()
        self._status, self._help = gui.Label(""), gui.Label(HELP)
        for widget in (self._scene, self._nodes, self._parameters, self._status, self._help):
            self.window.add_child(widget)
        self.window.set_on_layout(self._layout)
        self.window.set_on_tick_event(self._tick)
        self.window.set_on_key(self._key)
        self._scene.set_on_mouse(self._mouse)
        self._show()

    def _layout(self, _: Any) -> None:
        gui, whole, scale = self._gui, self.window.content_rect, self.window.scaling
        panel, bar = round(_PANEL * scale), round(_BAR * scale)
        right, high = whole.get_right() - panel, whole.height - bar
        self._scene.frame = gui.Rect(whole.x, whole.y, whole.width - panel, high)
        split = round(0.6 * high)
        self._nodes.frame = gui.Rect(right, whole.y, panel, split)
        self._parameters.frame = gui.Rect(right, whole.y + split, panel, high - split)
        low = whole.y + high
        self._status.frame = gui.Rect(whole.x + 8, low + 4, whole.width - 16, bar // 2)
        self._help.frame = gui.Rect(whole.x + 8, low + bar // 2, whole.width - 16, bar // 2)
        self._diagrams()

    def _tick(self) -> bool:
        now = time.monotonic()
        passed, self._last = now - self._last, now
        if self.scripted is not None:
            self.scripted.due(self.session, now - self._start)
        if self._end and now - self._start > self._end and not self._closing:
            self._closing = True
            self._finish()
        if not self.session.tick(passed, passed):
            return False
        self._show()
        if now - self._drawn > 0.15:
            self._drawn = now
            self._diagrams()
        return True

    def _finish(self) -> None:
        app = self._gui.Application.instance
        if self._picture is None:
            app.post_to_main_thread(self.window, self.window.close)
            return

        def save(image: Any) -> None:
            from PIL import Image

            Image.fromarray(np.asarray(image)).save(str(self._picture))
            app.post_to_main_thread(self.window, self.window.close)

        self._scene.scene.scene.render_to_image(save)

    def _key(self, event: Any) -> bool:
        if event.key == self._gui.KeyName.ESCAPE and not self._closing:
            self._closing = True
            self._finish()
            return True
        name = self._keys.get(event.key)
        if name is None:
            return False
        if event.type != self._gui.KeyEvent.Type.DOWN:
            self._down.discard(name)
            self.session.release(name)
        elif name not in self._down:
            # a key that is kept down comes again and again
            self._down.add(name)
            self.session.press(name)
        return True

    def _mouse(self, event: Any) -> Any:
        """With control held, the mouse draws on the ground; the path is followed when the button is let go."""
        gui = self._gui
        answer = gui.Widget.EventCallbackResult
        if not event.is_modifier_down(gui.KeyModifier.CTRL):
            return answer.IGNORED
        if event.type == gui.MouseEvent.Type.BUTTON_UP:
            self.session.follow()
        elif event.type in (gui.MouseEvent.Type.BUTTON_DOWN, gui.MouseEvent.Type.DRAG):
            place = self._on_ground(event.x, event.y)
            if place is not None:
                self.session.draw(*place)
        return answer.CONSUMED

    def _on_ground(self, x: float, y: float) -> tuple[float, float] | None:
        """Where the ray through a pixel of the window meets the ground, m; None above the horizon."""
        frame, camera = self._scene.frame, self._scene.scene.camera
        ends = [
            np.asarray(
                camera.unproject(x - frame.x, y - frame.y, depth, frame.width, frame.height), np.float64
            )
            for depth in (0.1, 0.9)
        ]
        fall = ends[0][1] - ends[1][1]
        if fall <= 1e-9:
            return None
        hit = ends[0] + (ends[1] - ends[0]) * (ends[0][1] / fall)
        home = self.session.character.root
        return float(hit[0] + home[0]), float(hit[2] + home[1])

    def _show(self) -> None:
        from open3d import geometry, utility

        character, scene = self.session.character, self._scene.scene
        home = np.array([character.root[0], 0.0, character.root[1]])
        if scene.has_geometry(_BODY):
            scene.remove_geometry(_BODY)
        body = Body(character.vertices, self.session.data.faces)
        scene.add_geometry(_BODY, as_mesh(body, home, self._room), self._material)
        ground = np.eye(4)
        ground[:3, 3] = -np.mod(home, 0.5)
        scene.set_geometry_transform(GRID, ground)
        places = np.full((_DOTS, 3), -9.0)
        drawn = self.session.path[-_DOTS:]
        if drawn:
            places[: len(drawn), [0, 2]] = np.array(drawn) - home[[0, 2]]
            places[: len(drawn), 1] = 0.01
        cloud = geometry.PointCloud(utility.Vector3dVector(places))
        cloud.paint_uniform_color([0.82, 0.29, 0.36])
        if scene.has_geometry(_PATH):
            scene.remove_geometry(_PATH)
        scene.add_geometry(_PATH, cloud, self._dot)
        self._scene.force_redraw()

    def _diagrams(self) -> None:
        for widget, paint in (
            (self._nodes, self.session.nodes_picture),
            (self._parameters, self.session.parameters_picture),
        ):
            size = (max(widget.frame.width, 200), max(widget.frame.height, 120))
            widget.update_image(as_image(paint(size)))
        self._status.text = self.session.status()
        self.window.post_redraw()
