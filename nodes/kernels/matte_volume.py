"""Where in space the performer can be, from the mattes alone."""

from __future__ import annotations

import numpy as np

from reperform.nodes.kernels.camera import centre


def refuse_mismatch(who: str, shape: tuple[int, ...], image_size: np.ndarray, names: np.ndarray) -> None:
    """Raise ValueError where pictures (camera, y, x, ...) and a calibration cannot belong together."""
    if shape[0] != len(names):
        raise ValueError(
            f"{who}: as many cameras as pictures are needed, got {shape[0]} pictures and {len(names)} cameras "
            f"({', '.join(map(str, names))}): choose the same cameras for footage and calibration"
        )
    for name, (width, height) in zip(names, image_size, strict=True):
        if (height, width) != shape[1:3]:
            raise ValueError(
                f"{who}: the calibration of camera {name} is for pictures of {width}x{height} px, got "
                f"{shape[2]}x{shape[1]} px: scale the pictures or take the calibration that belongs to them"
            )


def matte_boxes(alpha: np.ndarray) -> np.ndarray:
    """Bounding boxes (camera, 4) of what is more covered than not: left, top, right, bottom px; nan if none."""
    boxes = np.full((len(alpha), 4), np.nan)
    for camera, picture in enumerate(alpha):
        rows = np.flatnonzero((picture > 127).any(axis=1))
        columns = np.flatnonzero((picture > 127).any(axis=0))
        if len(rows):
            boxes[camera] = columns[0], rows[0], columns[-1], rows[-1]
    return boxes


def performer_ball(
    boxes: np.ndarray, matrix: np.ndarray, rotation: np.ndarray, translation: np.ndarray
) -> tuple[np.ndarray, float]:
    """Centre (3,) and radius (m) of a ball that holds what the boxes show.

    The centre is the point nearest to the rays through the boxes' middles, with cameras that miss it down-weighted
    (Cauchy, scale = median distance); the radius is the largest half diagonal of a box at that depth among the
    better half of the cameras, times 1.5. Lens distortion is left to that margin.
    """
    eyes = centre(rotation, translation)
    middle = 0.5 * (boxes[:, :2] + boxes[:, 2:])
    rays = np.concatenate([middle, np.ones((len(boxes), 1))], axis=1)
    rays = np.einsum("cji,cj->ci", rotation, np.einsum("cij,cj->ci", np.linalg.inv(matrix), rays))
    rays /= np.linalg.norm(rays, axis=1)[:, None]
    across = np.eye(3) - rays[:, :, None] * rays[:, None, :]
    weight = np.ones(len(boxes))
    point = np.zeros(3)
    for _ in range(20):
        normal = np.einsum("c,cij->ij", weight, across)
        point = np.linalg.solve(
            normal + 1e-9 * np.eye(3),
            np.einsum("c,cij,cj->i", weight, across, eyes) + 1e-9 * eyes.mean(axis=0),
        )
        miss = np.linalg.norm(np.einsum("cij,cj->ci", across, point - eyes), axis=1)
        weight = 1 / (1 + (miss / max(float(np.median(miss)), 1e-3)) ** 2)
    depth = np.einsum("i,ci->c", point, rotation[:, 2]) + translation[:, 2]
    diagonal = 0.5 * np.linalg.norm(boxes[:, 2:] - boxes[:, :2], axis=1)
    focal = 0.5 * (matrix[:, 0, 0] + matrix[:, 1, 1])
    radius = np.abs(depth) * diagonal / focal
    trusted = miss <= np.median(miss)
    return point, float(1.5 * radius[trusted].max() + miss[trusted].max())
