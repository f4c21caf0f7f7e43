"""What is being looked at: step, item, frame, finish and eye. Knows nothing of windows."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from reperform.nodes.products.mesh import TextureAtlas
from reperform.nodes.products.motion import Dissimilarity, MotionGraph, MotionPath
from reperform.viewer.browser import Browser
from reperform.viewer.contents import (
    atlas_of,
    frame_count,
    frames_per_second,
    has_mesh,
    mesh_frame,
    mesh_of,
    one_topology,
    summary,
)
from reperform.viewer.pictures.look import Look, Surface, View
from reperform.viewer.pictures.matrix import matrices_picture
from reperform.viewer.pictures.picture import PAINTERS, picture
from reperform.viewer.pictures.scene import Body, eye_for
from reperform.viewer.pictures.surface import dressed

ALL_PAIRS = "all pairs"
SURFACES: tuple[Surface, ...] = ("shaded", "textured", "checker")


@dataclass(frozen=True)
class Framing:
    """The ground that a take covers: where its first frame stands, and its bounds, metres."""

    low: np.ndarray
    high: np.ndarray
    distance: float


class Session:
    """The state of the viewer.

    browser: where results come from.  step, item: what to show first; the last step that has a result and its
    first item otherwise.  frame: counted from 0.

    Raises ValueError where there is no such step or item.
    """

    def __init__(
        self, browser: Browser, step: str | None = None, item: str | None = None, frame: int = 0
    ) -> None:
        self.browser = browser
        self.surface: Surface = "shaded"
        self.view = View()
        self.camera: int | None = None
        self.playing, self.speed, self.follow = False, 1.0, True
        self._rest = 0.0
        self._frame = 0
        self._product: Any = None
        self._atlases: dict[int, TextureAtlas | None] = {}
        self.step, self.item, self.problem = "", "", ""
        if not browser.steps():
            raise ValueError("there is nothing to view: the pipeline has no steps")
        self.select(step if step is not None else self._last_computed(), item)
        self.seek(frame)

    def _last_computed(self) -> str:
        steps = self.browser.steps()
        return next((step for step in reversed(steps) if self.browser.items(step)), steps[-1])

    def items(self, step: str | None = None) -> list[str]:
        """The items of a step (of the chosen one), after `all pairs` where they are pairs."""
        names = self.browser.items(self.step if step is None else step)
        return [ALL_PAIRS, *names] if len(names) > 1 and all("/" in name for name in names) else names

    def select(self, step: str, item: str | None = None) -> None:
        """Choose a step and one of its items; an item of the same name stays chosen, time starts anew."""
        if step not in self.browser.steps():
            raise ValueError(f"there is no step {step!r}; the steps are {', '.join(self.browser.steps())}")
        names = self.items(step)
        if item is not None and item not in names:
            raise ValueError(f"step {step!r} has no item {item!r}; it has {', '.join(names) or 'none yet'}")
        kept = self.item if self.item in names else (names[0] if names else "")
        self.step, self.item = step, kept if item is None else item
        self._open()

    def _open(self) -> None:
        self.__dict__.pop("framing", None)
        self._product, self.problem, self._rest = None, "", 0.0
        if not self.items():
            self.problem = f"{self.step} has not been computed: reperform run it first"
        elif self.item != ALL_PAIRS:
            try:
                self._product = self.browser.product(self.step, self.item)
            except (LookupError, OSError, ValueError) as error:
                self.problem = f"{self.step}{'/' + self.item if self.item else ''} cannot be read: {error}"
        self.seek(self._frame)

    @property
    def product(self) -> Any:
        """The chosen product; None where there is none (see `problem`) or where all pairs are shown."""
        return self._product

    @property
    def frames(self) -> int:
        """How many frames the chosen product has; at least 1."""
        return max(frame_count(self._product), 1) if self._product is not None else 1

    @property
    def frames_per_second(self) -> float:
        """Frame rate of the chosen product, Hz."""
        return frames_per_second(self._product) if self._product is not None else 25.0

    @property
    def frame(self) -> int:
        """The frame shown, from 0."""
        return self._frame

    def seek(self, frame: int) -> None:
        """Show a frame; one outside is brought to the nearest end."""
        self._frame = min(max(int(frame), 0), self.frames - 1)

    def play(self) -> None:
        """Let time run; at the end it starts anew."""
        self.playing, self._rest = self.frames > 1, 0.0

    def pause(self) -> None:
        """Hold the frame."""
        self.playing = False

    def tick(self, seconds: float) -> bool:
        """So much time has passed: whether the frame has changed."""
        if not self.playing:
            return False
        self._rest += seconds * self.speed * self.frames_per_second
        whole = math.floor(self._rest)
        self._rest -= whole
        before, self._frame = self._frame, (self._frame + whole) % self.frames
        return self._frame != before

    def orbit(self, turn: float, tilt: float) -> None:
        """Walk around what is shown, radians; the eye stays above the ground and short of the zenith."""
        tilted = min(max(self.view.elevation + tilt, -0.2), 1.45)
        self.view = replace(self.view, azimuth=self.view.azimuth + turn, elevation=tilted)

    @property
    def in_space(self) -> bool:
        """Whether the product is a surface to walk around, rather than a picture."""
        product = self._product
        return product is not None and type(product).__name__ not in PAINTERS and has_mesh(product)

    def body(self) -> Body:
        """The surface of the frame with its paint. Only where `in_space`."""
        return dressed(self._product, self._frame, self.look((960, 720)))

    @cached_property
    def framing(self) -> Framing:
        """Bounds of the surface over the take, from a few of its frames, and how far off all of it fits."""
        frames = np.unique(np.linspace(0, self.frames - 1, 7).astype(int))
        clouds = [mesh_frame(self._product, int(frame))[0] for frame in frames]
        clouds = [cloud for cloud in clouds if len(cloud)] or [np.zeros((1, 3))]
        own = np.concatenate([cloud - cloud.mean(0) for cloud in clouds])
        eye = eye_for(replace(self.view, target=(0.0, 0.0, 0.0), distance=None), own, (960, 720))
        return Framing(
            np.min([cloud.min(0) for cloud in clouds], 0),
            np.max([cloud.max(0) for cloud in clouds], 0),
            float(np.linalg.norm(eye.position)),
        )

    def look(self, size: tuple[int, int]) -> Look:
        """How the chosen frame is to be drawn: the eye follows the performer at a steady distance."""
        look = Look(size=size, view=self.view, surface=self.surface, camera=self.camera, title="")
        product = self._product
        if self.in_space:
            vertices, faces = mesh_frame(product, self._frame)
            middle = vertices.mean(0) if len(vertices) else np.zeros(3)
            middle[1] = (self.framing.low[1] + self.framing.high[1]) / 2
            view = replace(self.view, target=tuple(middle.tolist()), distance=self.framing.distance)
            atlas = self._atlas(len(faces)) if self.surface == "textured" else None
            return replace(look, view=view, atlas=atlas, reference=self._reference())
        if isinstance(product, Dissimilarity) or self.item == ALL_PAIRS:
            return replace(look, graph=self._graph(), pair=_pair(self.item) if "/" in self.item else None)
        if isinstance(product, MotionPath):
            return replace(look, tracks=self._tracks(np.asarray(product.provenance.takes).tolist()))
        return look

    def picture(self, size: tuple[int, int]) -> np.ndarray:
        """The chosen frame as an RGB uint8 picture, drawn without a display."""
        if self.item == ALL_PAIRS:
            names = self.browser.items(self.step)
            products = {_pair(name): self.browser.product(self.step, name) for name in names}
            if all(isinstance(product, Dissimilarity) for product in products.values()):
                return matrices_picture(products, self.look(size))
            self.select(self.step, names[0])
        if self._product is None:
            return picture_of_text(self.problem, size)
        return picture(self._product, self._frame, self.look(size))

    def caption(self) -> str:
        """One line: what is shown, and when."""
        where = self.step + (f" / {self.item}" if self.item else "")
        if self.frames == 1:
            return where
        return f"{where}, frame {self._frame} of {self.frames}, {self._frame / self.frames_per_second:.2f} s"

    def details(self) -> list[tuple[str, str]]:
        """The fields of the chosen product and what they hold."""
        return summary(self._product) if self._product is not None else []

    def finishes(self) -> list[Surface]:
        """The finishes that make a difference for what is shown."""
        if not self.in_space:
            return ["shaded"]
        atlas = self._atlas(len(mesh_frame(self._product, self._frame)[1])) is not None
        checker = one_topology(self._product)
        return [name for name in SURFACES if {"shaded": True, "textured": atlas, "checker": checker}[name]]

    def _each(self) -> Any:
        """The first product of every step that can be read."""
        for step in self.browser.steps():
            for item in self.browser.items(step)[:1]:
                try:
                    yield step, self.browser.product(step, item)
                except (LookupError, OSError, ValueError):
                    continue

    def _atlas(self, faces: int) -> TextureAtlas | None:
        """The atlas of the product, else one of any step that has as many faces."""
        own = atlas_of(self._product)
        if own is not None:
            return own
        if faces not in self._atlases:
            found = (atlas_of(product) for _, product in self._each())
            fits = (atlas for atlas in found if atlas is not None and np.shape(atlas.faces_uv)[0] == faces)
            self._atlases[faces] = next(fits, None)
        return self._atlases[faces]

    def _reference(self) -> np.ndarray | None:
        """One pose for the checker of all items of the step, so that colours agree between takes."""
        if self.surface != "checker" or not one_topology(self._product):
            return None
        first = self.browser.product(self.step, self.browser.items(self.step)[0])
        vertices, faces = mesh_frame(first, 0)
        return vertices if np.array_equal(faces, mesh_frame(self._product, 0)[1]) else None

    def _graph(self) -> MotionGraph | None:
        return next((product for _, product in self._each() if isinstance(product, MotionGraph)), None)

    def _tracks(self, takes: list[str]) -> dict[str, np.ndarray] | None:
        """Centroids of the takes' meshes over time, from the last step that has all of them."""
        for step, product in reversed(list(self._each())):
            if one_topology(product) and set(takes) <= set(self.browser.items(step)):
                meshes: dict[str, Any] = {take: mesh_of(self.browser.product(step, take)) for take in takes}
                return {take: np.asarray(mesh.vertices).mean(1) for take, mesh in meshes.items()}
        return None


def _pair(name: str) -> tuple[str, str]:
    a, _, b = name.partition("/")
    return a, b


def picture_of_text(text: str, size: tuple[int, int]) -> np.ndarray:
    """A page with a remark on it, for what cannot be shown."""
    from reperform.viewer.palette import PANEL, SOFT_INK, rgb
    from reperform.viewer.pictures.canvas import write_text

    page = np.empty((size[1], size[0], 3), np.uint8)
    page[:] = rgb(PANEL)
    return write_text(page, text, (size[0] / 2, size[1] / 2), 15, SOFT_INK, "mm")
