"""Where the texture of a surface went between two moments, as every camera saw it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import cv2
import numpy as np
from numba import njit

from reperform.nodes.kernels.camera import centre, project
from reperform.nodes.kernels.graph_fit import welsch
from reperform.nodes.kernels.rasterise import rasterise

# matrix, rotation, translation, distortion
Camera = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]

WINDOW = 11
# A point this far (m) behind the nearest surface in the depth picture is still seen.
_TOLERANCE = 0.02
_MARGIN = 32


class Sights(NamedTuple):
    """Lines of sight on which vertices should lie: vertex `vertex[m]` on origin[m] + s direction[m]."""

    vertex: np.ndarray  # (M,) int64
    origin: np.ndarray  # (M, 3) m
    direction: np.ndarray  # (M, 3) of length 1
    weight: np.ndarray  # (M,) in 0..1, how squarely the surface faced the camera


class Seen(NamedTuple):
    """A surface as one camera sees it."""

    pixels: np.ndarray  # (V, 2)
    facing: np.ndarray  # (V,) cosine between normal and line of sight; 0 where hidden or out of the picture


def see(
    vertices: np.ndarray, normals: np.ndarray, faces: np.ndarray, camera: Camera, height: int, width: int
) -> Seen:
    """Which vertices (V, 3) one camera sees, by a depth picture of half its size."""
    pixels, depth = project(vertices, *camera)
    half = (pixels - 0.5) / 2
    rows, columns = height // 2, width // 2
    nearest = rasterise(half, depth, faces, rows, columns)[2]
    inside = (half > 1).all(axis=1) & (half[:, 0] < columns - 2) & (half[:, 1] < rows - 2)
    x, y = np.where(inside[:, None], np.rint(np.nan_to_num(half)), 1).astype(int).T
    # the nearest depth of a small neighbourhood: what is beside an edge may show what is in front
    front = nearest[y, x]
    for right, down in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        front = np.minimum(front, nearest[y + down, x + right])
    towards = centre(camera[1], camera[2]) - vertices
    cosine = (towards * normals).sum(axis=1) / np.maximum(np.linalg.norm(towards, axis=1), 1e-9)
    # what a sloping surface falls away within a pixel of the depth picture
    slope = np.sqrt(np.maximum(1 - cosine**2, 0)) / np.maximum(cosine, 0.2)
    behind = _TOLERANCE + 2 * depth / camera[0][0, 0] * slope
    return Seen(pixels, np.where(inside & (depth < front + behind), np.maximum(cosine, 0), 0.0))


def track(
    before: np.ndarray,
    after: np.ndarray,
    points: np.ndarray,
    guess: np.ndarray,
    levels: int,
    round_trip: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Where points (N, 2) of a grey picture (H, W) uint8 are in another, (N, 2), and which were found, (N,).

    Pyramidal Lucas-Kanade from a guess (N, 2); found are those that return within `round_trip` px when
    tracked back. Only what surrounds the points is looked at.
    Source: Lucas and Kanade, IJCAI 1981; Bouguet, Intel 2001; Kalal, Mikolajczyk and Matas, ICPR 2010
    (forward-backward error).
    """
    both = np.concatenate([points, guess])
    low = np.maximum(np.floor(both.min(axis=0)).astype(int) - _MARGIN, 0)
    high = np.ceil(both.max(axis=0)).astype(int) + _MARGIN + 1
    source, target = (
        np.ascontiguousarray(picture[low[1] : high[1], low[0] : high[0]]) for picture in (before, after)
    )
    start = np.ascontiguousarray(points - low, np.float32)
    expected = np.ascontiguousarray(guess - low, np.float32)
    options: dict[str, Any] = {
        "winSize": (WINDOW, WINDOW),
        "maxLevel": levels,
        "flags": cv2.OPTFLOW_USE_INITIAL_FLOW,
        "criteria": (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 10, 0.03),
    }
    found, forth, _ = cv2.calcOpticalFlowPyrLK(source, target, start, expected.copy(), **options)
    # the way back starts beside the answer, as far off as the guess was
    returned, back, _ = cv2.calcOpticalFlowPyrLK(target, source, found, found + (start - expected), **options)
    good = (forth[:, 0] > 0) & (back[:, 0] > 0)
    good &= np.linalg.norm(returned - start, axis=1) < round_trip
    return found.astype(np.float64) + low, good


def track_surface(
    pictures: tuple[Sequence[np.ndarray], Sequence[np.ndarray]],
    cameras: tuple[Sequence[Camera], Sequence[Camera]],
    seen: tuple[Sequence[Seen], Sequence[Seen]],
    levels: int,
    round_trip: float,
) -> Sights:
    """Lines of sight of all vertices whose texture is found again.

    Each argument is a pair, before and after: grey pictures, cameras, and the surface as it was seen and as
    it is expected to be seen; camera c of both should be near each other. A camera counts where it faces the
    vertex, cosine over 0.2 before and 0.1 after.
    """
    parts = []
    for c in range(len(pictures[0])):
        at, expected = seen[0][c], seen[1][c]
        use = np.flatnonzero((at.facing > 0.2) & (expected.facing > 0.1))
        if not len(use):
            continue
        found, good = track(
            pictures[0][c], pictures[1][c], at.pixels[use], expected.pixels[use], levels, round_trip
        )
        use, found = use[good], found[good]
        if not len(use):
            continue
        matrix, rotation, translation, distortion = cameras[1][c]
        ideal = cv2.undistortPoints(found[:, None], np.asarray(matrix), np.asarray(distortion))[:, 0]
        ahead = np.column_stack([ideal, np.ones(len(ideal))])
        ahead = (ahead / np.linalg.norm(ahead, axis=1, keepdims=True)) @ rotation
        origin = np.broadcast_to(centre(rotation, translation), ahead.shape)
        parts.append(Sights(use, origin, ahead, at.facing[use]))
    if not parts:
        return Sights(np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0))
    return Sights(*(np.concatenate(field) for field in zip(*parts, strict=True)))


def add_sight_pull(
    sights: Sights,
    moved: np.ndarray,
    scale: float,
    strength: float,
    tensor: np.ndarray,
    force: np.ndarray,
) -> None:
    """Add to pull (V, 3, 3) and force (V, 3) what draws vertices `moved` (V, 3) sideways to their lines.

    Weight: strength x weight x Welsch(distance from the line; scale), so that a track that the others deny
    lets go.
    """
    _add(
        sights.vertex,
        np.ascontiguousarray(sights.origin),
        sights.direction,
        strength * sights.weight,
        moved,
        scale,
        tensor,
        force,
    )


@njit(cache=True, nogil=True)
def _add(
    vertex: np.ndarray,
    origin: np.ndarray,
    direction: np.ndarray,
    weight: np.ndarray,
    moved: np.ndarray,
    scale: float,
    tensor: np.ndarray,
    force: np.ndarray,
) -> None:
    away = np.zeros(3)
    for m in range(len(vertex)):
        i = vertex[m]
        along = 0.0
        for c in range(3):
            along += direction[m, c] * (moved[i, c] - origin[m, c])
        square = 0.0
        for c in range(3):
            away[c] = origin[m, c] + along * direction[m, c] - moved[i, c]
            square += away[c] ** 2
        w = weight[m] * welsch(square, scale)
        if w == 0:
            continue
        for r in range(3):
            force[i, r] += w * away[r]
            tensor[i, r, r] += w
            for c in range(3):
                tensor[i, r, c] -= w * direction[m, r] * direction[m, c]
