"""A cyclorama and its light: the floor and wall behind a performer, the shadow on them, the shading of a
surface.
"""

from __future__ import annotations

import cv2
import numpy as np

from reperform.nodes.kernels.mesh_geometry import vertex_areas

WALL_RADIUS = 6.5
# direction towards each soft lamp, and its share of the light
LAMPS = np.array([[0.45, 0.80, 0.55], [-0.75, 0.60, 0.10], [0.20, 0.70, -0.75]])
LAMP_SHARES = np.array([0.42, 0.22, 0.26])
AMBIENT = 0.40
# rays are cast on a coarse grid: the set is smooth
COARSE = 4


def lambert(normals: np.ndarray) -> np.ndarray:
    """Light on a surface with unit normals (N, 3): sum_k s_k max(0, n . l_k) plus half-sphere ambient;
    float32 (N,).
    """
    lamps = LAMPS / np.linalg.norm(LAMPS, axis=1, keepdims=True)
    wrapped = np.clip((normals @ lamps.T + 0.4) / 1.4, 0, None)
    sky = AMBIENT * (0.75 + 0.25 * normals[:, 1])
    return np.asarray(wrapped @ LAMP_SHARES * 1.45 + sky, np.float32)


def shadow_map(
    vertices: np.ndarray, faces: np.ndarray, half: float = 2.4, cell: float = 0.03
) -> tuple[np.ndarray, np.ndarray]:
    """(share of light lost on the floor (n, n) by z, x; its corner (x, z)) under a mesh lit softly from
    above.

    Surface area is dropped straight down: what is low darkens a small spot, what is high a wide one.
    """
    corner = vertices[:, [0, 2]].mean(axis=0) - half
    count = round(2 * half / cell)
    place = np.clip(((vertices[:, [0, 2]] - corner) / cell).astype(int), 0, count - 1)
    area = vertex_areas(vertices, faces)
    loss = np.zeros((count, count), np.float32)
    for reach, blur, strength in ((0.10, 0.035, 0.55), (0.45, 0.12, 0.30), (1.6, 0.32, 0.30)):
        weight = area * np.exp(-np.maximum(vertices[:, 1], 0) / reach)
        density = np.bincount(place[:, 1] * count + place[:, 0], weight, count * count) / (cell * cell)
        spread = cv2.GaussianBlur(density.reshape(count, count).astype(np.float32), (0, 0), blur / cell)
        loss = 1 - (1 - loss) * (1 - strength * (1 - np.exp(-spread)))
    return loss, corner


def cyclorama(
    matrix: np.ndarray, rotation: np.ndarray, translation: np.ndarray, image_size: np.ndarray, unevenness: float,
    shadow: tuple[np.ndarray, np.ndarray] | None, strength: float,
) -> np.ndarray:  # fmt: skip
    """Brightness (height, width), about 1, of floor and round wall as a camera sees them; lens distortion
    is ignored.

    unevenness: relative amplitude of the light's slow changes over the set. strength scales the shadow.
    """
    width, height = (int(value) for value in image_size)
    xs = (np.arange(-(-width // COARSE)) + 0.5) * COARSE - 0.5
    ys = (np.arange(-(-height // COARSE)) + 0.5) * COARSE - 0.5
    grid = np.stack([*np.meshgrid(xs, ys), np.ones((len(ys), len(xs)))], axis=-1)
    rays = grid @ (rotation.T @ np.linalg.inv(matrix)).T
    eye = -rotation.T @ translation
    with np.errstate(divide="ignore"):
        to_floor = np.where(rays[..., 1] < -1e-9, -eye[1] / np.minimum(rays[..., 1], -1e-9), np.inf)
    a = (rays[..., [0, 2]] ** 2).sum(-1)
    b = rays[..., 0] * eye[0] + rays[..., 2] * eye[2]
    c = eye[0] ** 2 + eye[2] ** 2 - WALL_RADIUS**2
    to_wall = (-b + np.sqrt(np.maximum(b * b - a * c, 0))) / np.maximum(a, 1e-9)
    hit = eye + rays * np.minimum(to_floor, to_wall)[..., None]
    x, y, z = hit[..., 0], np.maximum(hit[..., 1], 0), hit[..., 2]
    pools = (
        0.5 * np.sin(0.9 * x + 0.4) * np.cos(0.75 * z - 0.3)
        + 0.3 * np.sin(1.7 * z + 0.6 * x)
        + 0.2 * np.cos(2.3 * x)
    )
    fall = -0.5 * np.clip(y / 3.0, 0, 1.2) - 0.6 * np.clip((np.hypot(x, z) - 2.5) / 4.0, 0, 1)
    light = 1 + unevenness * (pools + fall)
    if shadow is not None and strength > 0:
        loss, corner = shadow
        cell = 4.8 / len(loss)
        at = ((np.stack([x, z], axis=-1) - corner) / cell - 0.5).astype(np.float32)
        lost = cv2.remap(loss, at, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT)
        light = light * (1 - strength * lost * (y < 0.02))
    full = cv2.resize(
        light.astype(np.float32), (len(xs) * COARSE, len(ys) * COARSE), interpolation=cv2.INTER_LINEAR
    )
    return full[:height, :width]
