"""Camera rigs and camera paths, in space and as a plan."""

from __future__ import annotations

from typing import Any

import numpy as np

from reperform.nodes.products.cameras import CameraPath, Cameras
from reperform.viewer.palette import ACCENT, INK, STATIONS, rgb, tint
from reperform.viewer.pictures.canvas import figure, pixels
from reperform.viewer.pictures.look import Look, View
from reperform.viewer.pictures.scene import Line, draw_scene

LENS = tuple(part / 255 for part in rgb(STATIONS["capture"]))


def cameras_picture(product: Cameras, frame: int, look: Look) -> np.ndarray:
    """The rig in space beside its plan: where each camera stands, what it sees at the ground's height."""
    poses = _poses(product.matrix, product.rotation, product.translation, product.image_size)
    names = np.asarray(product.name).tolist()
    return _beside(poses, names, np.zeros((0, 3)), look)


def camera_path_picture(product: CameraPath, frame: int, look: Look) -> np.ndarray:
    """The way of a virtual camera, with its pose at this frame."""
    rotation, translation = np.asarray(product.rotation), np.asarray(product.translation)
    count = len(rotation)
    way = -np.einsum("kji,kj->ki", rotation, translation)
    sizes = np.broadcast_to(np.asarray(product.image_size), (count, 2))
    matrix = np.asarray(product.matrix)
    pose = [part[frame : frame + 1] for part in (matrix, rotation, translation, sizes)]
    return _beside(_poses(*pose), [f"frame {frame}"], way, look)


def _poses(matrix: Any, rotation: Any, translation: Any, size: Any) -> list[tuple[np.ndarray, np.ndarray]]:
    """(centre, four corner rays) of each camera in the world; rays have depth 1."""
    poses = []
    for k, r, t, (width, height) in zip(*map(np.asarray, (matrix, rotation, translation, size)), strict=True):
        corners = np.array([[0, 0, 1], [width - 1, 0, 1], [width - 1, height - 1, 1], [0, height - 1, 1]])
        rays = corners @ np.linalg.inv(k).T @ r
        poses.append((-r.T @ t, rays))
    return poses


def _focus(poses: list[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """The point nearest to all optical axes (least squares); with one camera, 3 m in front of it."""
    a, b = np.zeros((3, 3)), np.zeros(3)
    for eye, rays in poses:
        axis = rays.mean(0) / np.linalg.norm(rays.mean(0))
        across = np.eye(3) - np.outer(axis, axis)
        a += across
        b += across @ eye
    if len(poses) < 2 or np.linalg.cond(a) > 1e6:
        eye, rays = poses[0]
        return np.asarray(eye + 3 * rays.mean(0))
    return np.asarray(np.linalg.solve(a, b))


def _beside(
    poses: list[tuple[np.ndarray, np.ndarray]], names: list[str], way: np.ndarray, look: Look
) -> np.ndarray:
    half = (look.size[0] // 2, look.size[1])
    return np.concatenate(
        [_in_space(poses, way, look, half), _plan(poses, names, way, (look.size[0] - half[0], half[1]))], 1
    )


def _in_space(
    poses: list[tuple[np.ndarray, np.ndarray]], way: np.ndarray, look: Look, size: tuple[int, int]
) -> np.ndarray:
    focus = _focus(poses)
    ground = min(0.0, float(min(eye[1] for eye, _ in poses)))
    lines = []
    for eye, rays in poses:
        far = 0.16 * float(np.linalg.norm(focus - eye))
        corners = eye + far * rays
        lines.append(Line(np.concatenate([corners, corners[:1]]), LENS, 1.6))
        lines += [Line(np.stack([eye, corner]), LENS, 1.6) for corner in corners]
        lines.append(
            Line(
                np.stack(
                    [corners[0], (corners[0] + corners[1]) / 2 - 0.3 * (corners[3] - corners[0]), corners[1]]
                ),
                LENS,
                1.6,
            )
        )
        lines.append(Line(np.stack([eye, [eye[0], ground, eye[2]]]), (0.62, 0.66, 0.70), 1.0))
    if len(way):
        lines.append(Line(way, tuple(part / 255 for part in rgb(ACCENT)), 2.0))
    lines.append(
        Line(
            np.array([[focus[0], ground, focus[2]], [focus[0], ground + 1.75, focus[2]]]),
            (0.82, 0.29, 0.36),
            3,
        )
    )
    view = View(
        look.view.azimuth,
        max(look.view.elevation, 0.45),
        look.view.target,
        look.view.distance,
        look.view.opening,
    )
    return draw_scene([], view, size, lines, ground, 1.0)


def _plan(
    poses: list[tuple[np.ndarray, np.ndarray]], names: list[str], way: np.ndarray, size: tuple[int, int]
) -> np.ndarray:
    focus = _focus(poses)
    with figure(size) as fig:
        axis = fig.subplots()
        for (eye, rays), name in zip(poses, names, strict=True):
            reach = 1.15 * float(np.hypot(*(focus - eye)[[0, 2]]))
            left, right = (rays[[k, 3 - k]].mean(0)[[0, 2]] for k in (0, 1))
            wedge = [eye[[0, 2]] + reach * side / max(np.hypot(*side), 1e-9) for side in (left, right)]
            axis.fill(
                *np.transpose([eye[[0, 2]], *wedge]), color=tint(STATIONS["capture"], 0.2), alpha=0.07, lw=0
            )
            axis.plot(*eye[[0, 2]], "o", color=STATIONS["capture"], markersize=6)
            out = eye[[0, 2]] - focus[[0, 2]]
            out = out / max(float(np.hypot(*out)), 1e-9)
            axis.annotate(
                f"{name}\n{eye[1]:.2f} m high",
                eye[[0, 2]],
                xytext=(18 * out[0], -18 * out[1]),
                textcoords="offset points",
                ha="left" if out[0] > 0.3 else "right" if out[0] < -0.3 else "center",
                va="top" if out[1] > 0.3 else "bottom" if out[1] < -0.3 else "center",
                fontsize=8,
                color=INK,
            )
        if len(way):
            axis.plot(way[:, 0], way[:, 2], color=ACCENT, linewidth=1.4)
        axis.plot(*focus[[0, 2]], "+", color=ACCENT, markersize=12, markeredgewidth=1.8)
        axis.grid(True, linewidth=0.5)
        axis.set_axisbelow(True)
        axis.margins(0.22)
        axis.set(aspect="equal", xlabel="x (m)", ylabel="z (m)", title="plan from above")
        # From above with x to the right, z points down the page.
        axis.invert_yaxis()
        return pixels(fig)
