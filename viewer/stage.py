"""The stage that windows show: sky, sun, a grid on the ground, and a camera over it."""

from __future__ import annotations

from typing import Any

import numpy as np

GRID = "grid"


def set_stage(window: Any, reach: float, opening: float) -> Any:
    """An Open3D scene widget with a grid of half metres up to `reach` m from its middle; opening: of the camera, degrees.

    The grid is to be moved, never replaced: replaced lines stop the drawing for good.
    """
    from open3d import geometry, utility
    from open3d.visualization import gui, rendering

    widget = gui.SceneWidget()
    widget.scene = rendering.Open3DScene(window.renderer)
    widget.scene.set_background([0.78, 0.84, 0.92, 1.0])
    widget.scene.scene.set_sun_light([0.35, -1.0, -0.45], [1.0, 1.0, 1.0], 90000)
    widget.scene.scene.enable_sun_light(True)
    at = np.arange(-round(2 * reach), round(2 * reach) + 1) * 0.5
    ends = [[[a, 0, -reach], [a, 0, reach]] for a in at] + [[[-reach, 0, a], [reach, 0, a]] for a in at]
    points = np.reshape(ends, (-1, 3)).astype(np.float64)
    lines = geometry.LineSet()
    lines.points = utility.Vector3dVector(points)
    lines.lines = utility.Vector2iVector(np.arange(len(points), dtype=np.int32).reshape(-1, 2))
    lines.paint_uniform_color([0.45, 0.50, 0.56])
    material = rendering.MaterialRecord()
    material.shader, material.line_width = "unlitLine", 1.2
    widget.scene.add_geometry(GRID, lines, material)
    bounds = geometry.AxisAlignedBoundingBox(np.full(3, -reach - 3.0), np.full(3, reach + 3.0))
    widget.setup_camera(opening, bounds, np.zeros(3, np.float32))
    return widget
