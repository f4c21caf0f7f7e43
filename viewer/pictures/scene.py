"""Scenes in space, drawn without a graphics library: clay or textured surfaces that cast shadows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from reperform.viewer.pictures.look import View

SUPERSAMPLE = 2
SKY_TOP, SKY_BOTTOM = np.array([0.80, 0.835, 0.87]), np.array([0.95, 0.96, 0.97])
GROUND, GRID = np.array([0.90, 0.91, 0.92]), np.array([0.76, 0.79, 0.82])
CLAY, INSIDE = np.array([0.86, 0.825, 0.785]), np.array([0.78, 0.42, 0.36])
# Towards the light, in the camera's frame (right, up, back), so that every view is well lit.
KEY, RIM = np.array([-0.45, 0.75, 0.55]), np.array([0.8, 0.35, -0.5])
# The shadow falls along a fixed world direction.
SUN = np.array([-0.35, 1.0, 0.25])


@dataclass(frozen=True)
class Body:
    """A mesh and how it is painted: either one colour, or colours (0-1) that `paint` finds at hits.

    vertices (V, 3) metres, faces (F, 3). uv (T, 2), faces_uv (F, 3), image (H, W, 3) uint8 texture it;
    reference (V, 3) draws a spatial checker of the reference positions.
    """

    vertices: np.ndarray
    faces: np.ndarray
    colour: np.ndarray = field(default_factory=lambda: CLAY)
    uv: np.ndarray | None = None
    faces_uv: np.ndarray | None = None
    image: np.ndarray | None = None
    reference: np.ndarray | None = None


@dataclass(frozen=True)
class Line:
    """A polyline in space: points (N, 3) metres, colour (0-1), width in pixels."""

    points: np.ndarray
    colour: Sequence[float]
    width: float = 2.0


@dataclass(frozen=True)
class Eye:
    """A pinhole camera (OpenCV's model) that looks at a scene."""

    matrix: np.ndarray
    rotation: np.ndarray
    translation: np.ndarray
    width: int
    height: int

    @property
    def position(self) -> np.ndarray:
        """Camera centre in the world, metres."""
        return np.asarray(-self.rotation.T @ self.translation)


def eye_for(view: View, points: np.ndarray, size: tuple[int, int]) -> Eye:
    """The camera of a view; without target or distance, one that sees all points with a margin."""
    from reperform.nodes.kernels.camera import look_at

    width, height = size
    points = points.reshape(-1, 3) if points.size else np.array([[-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]])
    low, high = points.min(0), points.max(0)
    target = (low + high) / 2 if view.target is None else np.array(view.target)
    elevation = np.clip(view.elevation, -1.5, 1.5)
    back = np.array(
        [
            np.sin(view.azimuth) * np.cos(elevation),
            np.sin(elevation),
            np.cos(view.azimuth) * np.cos(elevation),
        ]
    )
    half = np.tan(view.opening / 2)
    distance = view.distance
    if distance is None:
        rotation, _ = look_at(target + back, target)
        local = (points - target) @ rotation.T
        needs = np.maximum(abs(local[:, 0]) / (half * width / height), abs(local[:, 1]) / half) - local[:, 2]
        distance = float(max(needs.max() * 1.12, 0.05))
    rotation, translation = look_at(target + back * distance, target)
    focal = height / 2 / half
    matrix = np.array([[focal, 0, (width - 1) / 2], [0, focal, (height - 1) / 2], [0, 0, 1.0]])
    return Eye(matrix, rotation, translation, width, height)


def draw_scene(
    bodies: Sequence[Body],
    view: View,
    size: tuple[int, int],
    lines: Sequence[Line] = (),
    ground: float | None = 0.0,
    ground_grid: float = 0.5,
) -> np.ndarray:
    """The scene as an RGB uint8 picture (H, W, 3), antialiased.

    ground: height of the ground plane in metres (None: no ground).  ground_grid: spacing of its lines, m.
    Light: a key light and a rim light that move with the eye, a sky that is brighter above, and creases
    darkened where a pixel lies deeper than its surroundings.

    Source: Luft, Colditz, Deussen 2006, SIGGRAPH, "Image enhancement by unsharp masking the depth buffer".
    """
    import cv2

    clouds = [body.vertices for body in bodies] + [line.points for line in lines]
    cloud = np.concatenate(
        [np.asarray(part, np.float64).reshape(-1, 3) for part in clouds] or [np.zeros((0, 3))]
    )
    cloud = cloud[np.isfinite(cloud).all(1)]
    eye = eye_for(view, cloud, (size[0] * SUPERSAMPLE, size[1] * SUPERSAMPLE))
    canvas = _backdrop(eye, bodies, cloud, ground, ground_grid)
    depth = np.full((eye.height, eye.width), np.inf, np.float32)
    for body in bodies:
        _draw_body(canvas, depth, body, eye)
    # OpenCV draws smooth lines on bytes only.
    whole = np.ascontiguousarray((np.clip(canvas, 0, 1) * 255 + 0.5).astype(np.uint8))
    for line in lines:
        _draw_line(whole, line, eye)
    return np.asarray(cv2.resize(whole, size, interpolation=cv2.INTER_AREA))


def ground_under(cloud: np.ndarray) -> float:
    """Height of the ground: 0, the convention, unless what is shown plainly stands elsewhere."""
    if not cloud.size:
        return 0.0
    low, high = float(cloud[..., 1].min()), float(cloud[..., 1].max())
    return 0.0 if -0.12 <= low <= max(0.6, high - low) else low


def _backdrop(
    eye: Eye, bodies: Sequence[Body], cloud: np.ndarray, ground: float | None, spacing: float
) -> np.ndarray:
    rows = np.linspace(0, 1, eye.height)[:, None, None]
    canvas = np.broadcast_to(SKY_TOP + (SKY_BOTTOM - SKY_TOP) * rows, (eye.height, eye.width, 3)).astype(
        np.float32
    )
    if ground is None or eye.position[1] <= ground:
        return canvas
    x, y = np.meshgrid(np.arange(eye.width, dtype=np.float32), np.arange(eye.height, dtype=np.float32))
    inverse = (eye.rotation.T @ np.linalg.inv(eye.matrix)).astype(np.float32)
    ray_y = inverse[1, 0] * x + inverse[1, 1] * y + inverse[1, 2]
    below = ray_y < -1e-4
    x, y, ray_y = x[below], y[below], ray_y[below]
    reach = (ground - eye.position[1]) / ray_y
    here = (
        np.stack([inverse[k, 0] * x + inverse[k, 1] * y + inverse[k, 2] for k in (0, 2)], 1) * reach[:, None]
    )
    here += eye.position[[0, 2]].astype(np.float32)
    middle = (cloud.min(0) + cloud.max(0))[[0, 2]] / 2 if len(cloud) else np.zeros(2)
    extent = float(np.linalg.norm(np.ptp(cloud, axis=0))) if len(cloud) else 2.0
    fade = np.exp(-((np.linalg.norm(here - middle, axis=1) / (1.6 * extent + 0.6)) ** 2))[:, None]
    colour = GROUND + (GRID - GROUND) * (_grid_lines(here, reach / eye.matrix[0, 0], spacing)[:, None])
    colour = colour * (1 - 0.42 * _shadow(bodies, here, ground)[:, None])
    canvas[below] = canvas[below] * (1 - fade) + colour * fade
    return canvas


def _grid_lines(here: np.ndarray, pixel: np.ndarray, spacing: float) -> np.ndarray:
    """Share of grid line in each pixel: lines of 1 px at least, fading where they get too dense."""
    off = abs((here / spacing + 0.5) % 1.0 - 0.5) * spacing
    width = np.maximum(0.004, 1.2 * pixel)[:, None]
    lines = np.clip(1.5 - off / width, 0, 1)
    return np.asarray(lines.max(1) * np.clip(1.6 - 14 * pixel / spacing, 0, 1))


def _shadow(bodies: Sequence[Body], here: np.ndarray, ground: float) -> np.ndarray:
    """Soft shadow at ground points (x, z): what the sun does not reach, blurred, 0-1."""
    import cv2

    from reperform.nodes.kernels.rasterise import rasterise

    if not bodies or not len(here):
        return np.zeros(len(here), np.float32)
    falls = [
        body.vertices[:, [0, 2]] - SUN[[0, 2]] / SUN[1] * (body.vertices[:, 1:2] - ground) for body in bodies
    ]
    every = np.concatenate(falls)
    low, high = every.min(0) - 0.4, every.max(0) + 0.4
    texel = max(float((high - low).max()) / 700, 0.004)
    width, height = (int(n) + 1 for n in (high - low) / texel)
    dark = np.zeros((height, width), np.float32)
    for body, fall in zip(bodies, falls, strict=True):
        ids, _, _ = rasterise((fall - low) / texel, np.ones(len(fall)), body.faces, height, width)
        dark = np.maximum(dark, (ids >= 0).astype(np.float32))
    dark = 0.5 * cv2.GaussianBlur(dark, (0, 0), 0.02 / texel) + 0.5 * cv2.GaussianBlur(
        dark, (0, 0), 0.09 / texel
    )
    at = ((here - low) / texel).astype(np.float32)
    return look_up(dark, at[:, 0], at[:, 1], cv2.BORDER_CONSTANT)


def _draw_body(canvas: np.ndarray, nearest: np.ndarray, body: Body, eye: Eye) -> None:
    from reperform.nodes.kernels.camera import project
    from reperform.nodes.kernels.mesh_geometry import vertex_normals
    from reperform.nodes.kernels.rasterise import interpolate, rasterise

    if not len(body.faces):
        return
    points, distance = project(body.vertices, eye.matrix, eye.rotation, eye.translation)
    ids, bary, depth = rasterise(points, distance, body.faces, eye.height, eye.width)
    hit = depth < nearest
    if not hit.any():
        return
    nearest[hit] = depth[hit]
    faces, weights = ids[hit], bary[hit]
    normal = interpolate(vertex_normals(body.vertices, body.faces), body.faces, faces, weights)
    normal = normal @ (eye.rotation.T * [1, -1, -1])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-9)
    corners = body.vertices[body.faces]
    out = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inside = ((out * (eye.position - corners[:, 0])).sum(1) < 0)[faces]
    normal[inside] *= -1
    paint, ambient = _paint(body, faces, weights)
    paint = np.where(inside[:, None], 0.5 * paint + 0.5 * INSIDE, paint)
    canvas[hit] = _light(paint, normal, ambient) * (1 - 0.55 * _creases(depth, body))[hit][:, None]


def _light(paint: np.ndarray, normal: np.ndarray, ambient: float) -> np.ndarray:
    key = np.clip(normal @ (KEY / np.linalg.norm(KEY)), 0, 1)
    rim = np.clip(normal @ (RIM / np.linalg.norm(RIM)), 0, 1) * (1 - np.clip(normal[:, 2], 0, 1)) ** 2
    sky = 0.5 + 0.5 * normal[:, 1]
    strength = ambient * (0.62 + 0.38 * sky) + (1.12 - ambient) * key
    return np.asarray(paint * strength[:, None] + (0.25 * rim)[:, None])


def _creases(depth: np.ndarray, body: Body) -> np.ndarray:
    """How much deeper each pixel lies than its surroundings on the same body, 0-1."""
    import cv2

    seen = np.isfinite(depth)
    known = np.where(seen, depth, 0).astype(np.float32)
    scale = max(float(np.ptp(body.vertices, axis=0).max()), 1e-6)
    radius = depth.shape[0] / 60
    share = cv2.GaussianBlur(seen.astype(np.float32), (0, 0), radius)
    mean = cv2.GaussianBlur(known, (0, 0), radius) / np.maximum(share, 1e-6)
    return np.asarray(np.clip((known - mean) / (0.05 * scale), 0, 1) * seen)


def _paint(body: Body, faces: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, float]:
    """Colours (N, 3) at hits, and how much of the light comes from everywhere."""
    from reperform.nodes.kernels.rasterise import interpolate

    if body.image is not None and body.uv is not None and body.faces_uv is not None:
        uv = interpolate(body.uv, body.faces_uv, faces, weights)
        return sample_atlas(body.image, uv), 0.78
    if body.reference is not None:
        return checker_colours(body.reference, interpolate(body.reference, body.faces, faces, weights)), 0.6
    return np.broadcast_to(body.colour, (len(faces), 3)), 0.46


def sample_atlas(image: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """Colours 0-1 (N, 3) of an atlas at uv (N, 2): u right, v up, (0, 0) the image's bottom-left corner."""
    import cv2

    height, width = image.shape[:2]
    x = (uv[:, 0] * width - 0.5).astype(np.float32)
    y = ((1 - uv[:, 1]) * height - 0.5).astype(np.float32)
    return look_up(image, x, y, cv2.BORDER_REPLICATE) / 255.0


def look_up(image: np.ndarray, x: np.ndarray, y: np.ndarray, border: int) -> np.ndarray:
    """Bilinear values (N,) or (N, C) of an image at pixel positions x, y (N,) float32."""
    import cv2

    # OpenCV's remap takes at most 32767 rows or columns: the list of points is folded into a sheet.
    columns = 1024
    rows = -(-len(x) // columns)
    sheet = np.zeros((2, rows * columns), np.float32)
    sheet[:, : len(x)] = x, y
    folded = sheet.reshape(2, rows, columns)
    values = cv2.remap(image, folded[0], folded[1], cv2.INTER_LINEAR, borderMode=border)
    return np.asarray(values).reshape(rows * columns, *image.shape[2:])[: len(x)]


def checker_colours(reference: np.ndarray, at: np.ndarray) -> np.ndarray:
    """A spatial checker with hues by position (N, 3): the same colour is the same physical point.

    The cell is a 24th of the reference's longest side.
    """
    low, high = reference.min(0), reference.max(0)
    cell = float((high - low).max()) / 24
    parity = np.floor((at - low) / cell).astype(np.int64).sum(1) % 2
    where = (at - low) / np.maximum(high - low, 1e-9)
    hue = 0.22 + 0.76 * where
    return np.where(parity[:, None] == 1, hue, 0.97 - 0.15 * (1 - hue))


def _draw_line(canvas: np.ndarray, line: Line, eye: Eye) -> None:
    import cv2

    from reperform.nodes.kernels.camera import project

    points, _ = project(np.asarray(line.points, np.float64), eye.matrix, eye.rotation, eye.translation)
    whole = np.isfinite(points).all(1) & (abs(points) < 1e5).all(1)
    colour = [round(255 * part) for part in line.colour]
    thick = max(1, round(line.width * SUPERSAMPLE))
    for k in range(len(points) - 1):
        if whole[k] and whole[k + 1]:
            a, b = ((points[j] * 16).round().astype(int).tolist() for j in (k, k + 1))
            cv2.line(canvas, a, b, colour, thick, cv2.LINE_AA, 4)
