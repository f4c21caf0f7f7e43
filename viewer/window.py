"""The window: walk around any surface of any step, scrub and play time, look at any picture."""

from __future__ import annotations

import gc
import os
import sys
import time
from typing import Any

import numpy as np

from reperform.viewer.browser import Browser
from reperform.viewer.pictures.scene import CLAY, Body, checker_colours
from reperform.viewer.session import Session
from reperform.viewer.stage import GRID, set_stage

SIZE = (1280, 800)
PANEL, BAR, TREE = 250, 74, 0.58
# Seconds between two ticks from which drawing counts as slow.
SLOW = 0.25
BODY = "body"


class NoDisplayError(RuntimeError):
    """There is no screen to open a window on."""


def check_display() -> None:
    """Raise NoDisplayError where no window can open; Open3D would end the process instead."""
    if sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
        raise NoDisplayError(
            "the viewer needs a display, and DISPLAY is not set: use --screenshot FILE for a picture "
            "without one, or start it on a desktop, over ssh -X, or under xvfb-run"
        )


def open_window(session: Session, size: tuple[int, int] = SIZE) -> None:
    """Show a session in a window until it is closed. Raises NoDisplayError without a display."""
    check_display()
    from open3d.visualization import gui

    app = gui.Application.instance
    app.initialize()
    shown = Window(session, app.create_window(session.browser.title or "reperform", *size))
    app.run()
    # Widgets that outlive the application end the process with a fault when Python exits.
    shown.__dict__.clear()
    gc.collect()


class Window:
    """Widgets around a session: they change the session, and `refresh` shows what the session says."""

    def __init__(self, session: Session, window: Any) -> None:
        from open3d.visualization import gui, rendering

        self.session, self.window = session, window
        self._gui, self._rendering = gui, rendering
        self._last, self._shown, self._smooth = time.monotonic(), ("", ""), True
        self._material_key: tuple[str, str, str] | None = None
        self._material: Any = None
        self._room, self._wish = 1 << 15, session.surface
        self._rows: dict[int, tuple[str, str]] = {}
        self._build_panel()
        self._build_bar()
        self._scene = set_stage(window, 3.0, float(np.degrees(session.view.opening)))
        # Buttons and sliders stay quick where drawing the scene is slow.
        self._scene.enable_scene_caching(True)
        self._picture = gui.ImageWidget()
        for widget in (self._tree, self._panel, self._scene, self._picture, self._bar):
            window.add_child(widget)
        window.set_on_layout(self._layout)
        window.set_on_tick_event(self._tick)
        window.set_on_key(self._key)
        self.refresh()

    def refresh(self) -> None:
        """Show what the session says."""
        session = self.session
        chosen = (session.step, session.item)
        fresh = chosen != self._shown
        self._shown = chosen
        self._slider.set_limits(0, max(session.frames - 1, 1))
        self._slider.enabled = self._play.enabled = session.frames > 1
        self._slider.int_value = session.frame
        self._play.text = "Pause" if session.playing else "Play"
        self._caption.text = session.caption() if not session.problem else session.problem
        if fresh:
            self._offer_finishes()
            self._describe()
            self.window.set_needs_layout()
        self._scene.visible = session.in_space
        self._picture.visible = not session.in_space
        if session.in_space:
            self._show_body(fresh)
        else:
            self._show_picture()
        self.window.post_redraw()

    def _build_panel(self) -> None:
        gui, em = self._gui, self.window.theme.font_size
        self._tree = gui.TreeView()
        self._tree.can_select_items_with_children = True
        root = self._tree.get_root_item()
        for step in self.session.browser.steps():
            state = self.session.browser.status(step)
            name = step if state in ("fresh", "") else f"{step}  ({state})"
            row = self._tree.add_text_item(root, name)
            self._rows[row] = (step, "")
            items = [item for item in self.session.items(step) if item]
            for item in items:
                self._rows[self._tree.add_text_item(row, item)] = (step, item)
        self._tree.set_on_selection_changed(self._choose)
        self._panel = gui.Vert(0.4 * em, gui.Margins(0.6 * em, 0.4 * em, 0.6 * em, 0.6 * em))
        self._finish = gui.Combobox()
        self._finish.set_on_selection_changed(self._set_finish)
        self._panel.add_child(self._finish)
        self._follow = gui.Checkbox("Follow the performer")
        self._follow.checked = self.session.follow
        self._follow.set_on_checked(self._set_follow)
        self._panel.add_child(self._follow)
        self._details = gui.Label("")
        fields = gui.ScrollableVert(0, gui.Margins(0, 0.3 * em, 0, 0))
        fields.add_child(self._details)
        self._panel.add_child(fields)

    def _build_bar(self) -> None:
        gui, em = self._gui, self.window.theme.font_size
        self._bar = gui.Vert(0.2 * em, gui.Margins(0.6 * em, 0.4 * em, 0.6 * em, 0.2 * em))
        row = gui.Horiz(0.5 * em)
        self._play = gui.Button("Play")
        self._play.set_on_clicked(self._toggle)
        self._slider = gui.Slider(gui.Slider.INT)
        self._slider.set_on_value_changed(self._seek)
        row.add_child(self._play)
        row.add_child(self._slider)
        self._caption = gui.Label("")
        self._bar.add_child(row)
        self._bar.add_child(self._caption)

    def _layout(self, _: Any) -> None:
        gui, whole, scale = self._gui, self.window.content_rect, self.window.scaling
        panel, bar = round(PANEL * scale), round(BAR * scale)
        low = whole.y + round(TREE * whole.height)
        self._tree.frame = gui.Rect(whole.x, whole.y, panel, low - whole.y)
        self._panel.frame = gui.Rect(whole.x, low, panel, whole.get_bottom() - low)
        main = gui.Rect(whole.x + panel, whole.y, whole.width - panel, whole.height - bar)
        self._scene.frame = self._picture.frame = main
        self._bar.frame = gui.Rect(whole.x + panel, whole.get_bottom() - bar, whole.width - panel, bar)
        if not self.session.in_space:
            self._show_picture()

    def _choose(self, row: int) -> None:
        step, item = self._rows[row]
        self.session.select(step, item or None)
        self.refresh()

    def _set_finish(self, name: str, _: int) -> None:
        self._wish = self.session.surface = next(f for f in self.session.finishes() if f == name)
        self.refresh()

    def _set_follow(self, follow: bool) -> None:
        self.session.follow = follow
        self._shown = ("", "")
        self.refresh()

    def _toggle(self) -> None:
        if self.session.playing:
            self.session.pause()
        else:
            self.session.play()
            self._last = time.monotonic()
        self.refresh()

    def _seek(self, frame: float) -> None:
        self.session.seek(round(frame))
        self.refresh()

    def _tick(self) -> bool:
        now = time.monotonic()
        passed, self._last = now - self._last, now
        if passed > SLOW and self._smooth:
            # Without a graphics card, smooth edges cost ten times the rest.
            self._scene.scene.view.set_antialiasing(False)
            self._smooth = False
        if self.session.tick(passed):
            self.refresh()
            return True
        return False

    def _key(self, event: Any) -> bool:
        gui = self._gui
        if event.type != gui.KeyEvent.Type.DOWN:
            return False
        if event.key == gui.KeyName.SPACE:
            self._toggle()
        elif event.key in (gui.KeyName.LEFT, gui.KeyName.RIGHT):
            self._seek(self.session.frame + (1 if event.key == gui.KeyName.RIGHT else -1))
        else:
            return False
        return True

    def _offer_finishes(self) -> None:
        finishes = self.session.finishes()
        self._finish.clear_items()
        for finish in finishes:
            self._finish.add_item(finish)
        self.session.surface = self._wish if self._wish in finishes else finishes[0]
        self._finish.selected_text = self.session.surface
        self._finish.visible = self._follow.visible = self.session.in_space

    def _describe(self) -> None:
        lines = [type(self.session.product).__name__] if self.session.product is not None else []
        for name, holds in self.session.details():
            lines += [name, "    " + holds]
        self._details.text = "\n".join(lines)

    def _show_picture(self) -> None:
        frame = self._picture.frame
        size = (max(frame.width, 320), max(frame.height, 240))
        self._picture.update_image(as_image(self.session.picture(size)))

    def _show_body(self, fresh: bool) -> None:
        body, scene = self.session.body(), self._scene.scene
        # A surface in a scene cannot change: it is taken out and a new one put in.
        if scene.has_geometry(BODY):
            scene.remove_geometry(BODY)
        self._room = max(self._room, 1 << (len(body.faces) - 1).bit_length())
        home = self._home(body)
        scene.add_geometry(BODY, as_mesh(body, home, self._room), self._material_for(body))
        if fresh:
            self._stand_back()
        self._scene.force_redraw()

    def _home(self, body: Body) -> np.ndarray:
        """What is subtracted from the surface so that the eye can stay where it is."""
        middle = body.vertices.mean(0) if len(body.vertices) else np.zeros(3)
        return middle * [1, 0, 1] if self.session.follow else np.zeros(3)

    def _stand_back(self) -> None:
        session, framing = self.session, self.session.framing
        middle = (framing.low + framing.high) / 2
        target = np.array([0.0, middle[1], 0.0]) if session.follow else middle
        across = 0.0 if session.follow else 0.8 * float(np.linalg.norm((framing.high - framing.low)[[0, 2]]))
        view, distance = session.view, framing.distance + across
        back = np.array(
            [
                np.sin(view.azimuth) * np.cos(view.elevation),
                np.sin(view.elevation),
                np.cos(view.azimuth) * np.cos(view.elevation),
            ]
        )
        eye = (target + distance * back).astype(np.float32)
        self._scene.look_at(target.astype(np.float32), eye, np.array([0, 1, 0], np.float32))
        ground = np.eye(4)
        ground[:3, 3] = target * [1, 0, 1]
        self._scene.scene.set_geometry_transform(GRID, ground)

    def _material_for(self, body: Body) -> Any:
        """The material of a surface; kept, so that a texture goes to the graphics card once."""
        key = (self.session.step, self.session.item, self.session.surface)
        if self._material is None or key != self._material_key:
            material = self._rendering.MaterialRecord()
            material.shader, material.base_roughness, material.base_reflectance = "defaultLit", 0.9, 0.2
            if body.image is not None:
                material.albedo_img = as_image(body.image)
            self._material, self._material_key = material, key
        return self._material


def as_image(picture: np.ndarray) -> Any:
    """An Open3D image of an RGB uint8 picture."""
    from open3d import geometry

    make: Any = geometry.Image
    return make(np.ascontiguousarray(picture))


def as_mesh(body: Body, home: np.ndarray, room: int) -> Any:
    """An Open3D mesh of a body, moved so that `home` (3,) is the origin, filled up to `room` triangles.

    Every triangle has corners of its own with colours and uv, so that all surfaces have buffers of one size and
    layout: on a software Vulkan driver a change of these ends all drawing.
    """
    from open3d import geometry, utility

    from reperform.nodes.kernels.mesh_geometry import vertex_normals

    faces = body.faces
    normals = vertex_normals(body.vertices, faces)
    colours = np.broadcast_to(CLAY, body.vertices.shape)
    uv = np.zeros((3 * room, 2))
    if body.uv is not None and body.faces_uv is not None:
        uv[: 3 * len(faces)] = np.asarray(body.uv)[np.asarray(body.faces_uv)].reshape(-1, 2)
        colours = np.ones_like(body.vertices)
    elif body.reference is not None:
        colours = checker_colours(body.reference, body.reference)
    soup = np.zeros((3, 3 * room, 3))
    for row, values in zip(soup, (body.vertices - home, normals, colours), strict=True):
        row[: 3 * len(faces)] = values[faces].reshape(-1, 3)
    mesh = geometry.TriangleMesh(
        utility.Vector3dVector(soup[0]),
        utility.Vector3iVector(np.arange(3 * room, dtype=np.int32).reshape(-1, 3)),
    )
    mesh.vertex_normals = utility.Vector3dVector(soup[1])
    mesh.vertex_colors = utility.Vector3dVector(soup[2])
    mesh.triangle_uvs = utility.Vector2dVector(uv)
    return mesh


def view(
    browser: Browser,
    step: str | None = None,
    item: str | None = None,
    frame: int = 0,
    surface: str | None = None,
    size: tuple[int, int] = SIZE,
) -> None:
    """Open the viewer on the results of a pipeline.

    step, item, frame, surface: what to show first.
    Raises NoDisplayError without a display, ValueError where there is no such step, item or finish.
    """
    check_display()
    open_window(start_session(browser, step, item, frame, surface), size)


def start_session(
    browser: Browser, step: str | None, item: str | None, frame: int, surface: str | None
) -> Session:
    """A session that shows this. Without a finish, surfaces are textured where an atlas fits.

    Raises ValueError where there is no such step, item or finish.
    """
    session = Session(browser, step, item, frame)
    offered = session.finishes()
    if surface is None:
        session.surface = "textured" if "textured" in offered else "shaded"
    elif surface in offered:
        session.surface = next(finish for finish in offered if finish == surface)
    else:
        raise ValueError(f"{session.caption()} can be shown {', '.join(offered)}, got {surface!r}")
    return session
