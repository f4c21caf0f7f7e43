"""The studio's cameras."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.camera import look_at
from reperform.nodes.products.cameras import Cameras


@node(over="dataset")
def rig(
    *,
    cameras: Annotated[int, Param("cameras", 1, 64, "how many")] = 8,
    radius: Annotated[float, Param("m", 1.0, 30.0, "of the circle they stand on")] = 4.0,
    height: Annotated[float, Param("m", 0.1, 10.0, "of the cameras over the floor")] = 2.4,
    width: Annotated[int, Param("px", 16, 8192, "of the pictures")] = 960,
    picture_height: Annotated[int, Param("px", 16, 8192, "of the pictures")] = 540,
    stage_radius: Annotated[
        float, Param("m", 0.2, 20.0, "of the ground that every camera keeps in frame")
    ] = 1.5,
    stage_height: Annotated[float, Param("m", 0.5, 5.0, "up to which every camera keeps it in frame")] = 2.0,
    unevenness: Annotated[
        float, Param("1", 0.0, 0.4, "random share of azimuth step, radius and height")
    ] = 0.08,
    seed: Annotated[int, Param("", 0, 2**31 - 1, "of the unevenness")] = 1,
) -> Cameras:
    """Cameras on a circle that look at a stage round the origin and keep all of it in frame.

    The stage is the upright cylinder of stage_radius and stage_height (m) on the floor. Camera k stands at
    azimuth 2 pi (k + e) / n, seen from the origin; e, and the relative changes of radius and height, are
    drawn once from the seed, uniform in +-unevenness. Each camera looks at the axis so that top and bottom
    of the stage are equally far from the picture's edges; one focal length for all, the longest that keeps
    the stage in frame, square pixels, no distortion.

    Raises ValueError where a camera would stand on the stage.
    Source: 004 section 2.2 (8 cameras on a circle of 8 m diameter, about 2 m up).
    """
    random = np.random.default_rng(seed).uniform(-unevenness, unevenness, (cameras, 3))
    azimuth = 2 * np.pi * (np.arange(cameras) + random[:, 0]) / cameras
    distance = radius * (1 + random[:, 1])
    level = height * (1 + random[:, 2])
    if distance.min() <= stage_radius:
        raise ValueError(
            f"studio.rig: every camera must stand off the stage of radius {stage_radius} m, got one at "
            f"{distance.min():.2f} m: raise radius or lower stage_radius"
        )
    rotations, translations, focals = [], [], []
    for k in range(cameras):
        eye = np.array([distance[k] * np.sin(azimuth[k]), level[k], distance[k] * np.cos(azimuth[k])])
        near, far = distance[k] - stage_radius, distance[k] + stage_radius
        lowest = min(-np.arctan2(level[k], near), -np.arctan2(level[k], far))
        highest = max(np.arctan2(stage_height - level[k], near), np.arctan2(stage_height - level[k], far))
        pitch = 0.5 * (lowest + highest)
        rotation, translation = look_at(eye, np.array([0.0, eye[1] + distance[k] * np.tan(pitch), 0.0]))
        rotations.append(rotation)
        translations.append(translation)
        focals.append(_focal(rotation, translation, stage_radius, stage_height, width, picture_height))
    focal = min(focals)
    matrix = np.array([[focal, 0, (width - 1) / 2], [0, focal, (picture_height - 1) / 2], [0, 0, 1.0]])
    return Cameras(
        np.tile(matrix, (cameras, 1, 1)),
        np.stack(rotations),
        np.stack(translations),
        np.zeros((cameras, 5)),
        np.tile(np.array([width, picture_height], np.int32), (cameras, 1)),
        np.array([f"cam{k}" for k in range(cameras)]),
    )


def _focal(
    rotation: np.ndarray, translation: np.ndarray, radius: float, top: float, width: int, height: int
) -> float:
    """The longest focal length (px) at which the rims of the stage stay in frame, with 2 % to spare."""
    angle = 2 * np.pi * np.arange(72) / 72
    rim = np.column_stack([radius * np.sin(angle), np.zeros(72), radius * np.cos(angle)])
    points = np.concatenate([rim, rim + [0, top, 0]]) @ rotation.T + translation
    slopes = np.abs(points[:, :2] / points[:, 2:]).max(axis=0)
    return float(0.98 * min((width - 1) / 2 / slopes[0], (height - 1) / 2 / slopes[1]))
