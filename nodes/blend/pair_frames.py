"""Corresponding frames of two takes, for blending them along their whole length."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np

from reperform.nodes.kernels.ground_plane import align, apply
from reperform.nodes.products.mesh import MeshSequence

Pace = Literal["stretched", "frame by frame"]
_SAMPLE = 400


def corresponding_frames(
    first: MeshSequence, second: MeshSequence, weight: float, pace: Pace, place: bool, who: str
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Pairs of poses (V, 3), one pair per frame of the blend, m.

    stretched: both takes are run through from end to end in (1 - weight) T_a + weight T_b frames, poses
    between captured frames by linear interpolation; frame by frame: up to the shorter one's end.
    place: lay the second on the first by one ground-plane motion (least squares over all pairs).
    Raises ValueError where topology or frame rate differ.
    """
    if not np.array_equal(first.faces, second.faces) or first.vertices.shape[1] != second.vertices.shape[1]:
        raise ValueError(f"{who}: both takes must share one topology: align them first")
    if not np.isclose(first.fps, second.fps):
        raise ValueError(f"{who}: both takes must share one frame rate, got {first.fps} and {second.fps} Hz")
    lengths = len(first.vertices), len(second.vertices)
    if pace == "stretched":
        count = max(1, round((1.0 - weight) * lengths[0] + weight * lengths[1]))
    else:
        count = min(lengths)
    times = [
        np.linspace(0.0, length - 1.0, count) if pace == "stretched" else np.arange(float(count))
        for length in lengths
    ]
    vertices = np.asarray(second.vertices)
    if place:
        step = max(1, vertices.shape[1] // _SAMPLE)
        samples = [
            np.stack([pose_at(sequence.vertices[:, ::step], t) for t in along]).reshape(-1, 3)
            for sequence, along in zip((first, second), times, strict=True)
        ]
        placement, _ = align(*samples)
        vertices = apply(vertices, placement)
    for t, u in zip(*times, strict=True):
        yield pose_at(first.vertices, t), pose_at(vertices, u)


def lay_on(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """The second take's poses (T, V, 3) moved over the ground to lie on the first's, pose by pose."""
    step = max(1, first.shape[1] // _SAMPLE)
    placement, _ = align(first[:, ::step].reshape(-1, 3), second[:, ::step].reshape(-1, 3))
    return apply(second, placement)


def pose_at(vertices: np.ndarray, time: float) -> np.ndarray:
    """The pose at a time in frames: between two frames by linear interpolation."""
    before = int(np.floor(time + 1e-9))
    part = time - before
    if part < 1e-9:
        return np.asarray(vertices[before])
    return np.asarray((1.0 - part) * vertices[before] + part * vertices[before + 1], np.float32)
