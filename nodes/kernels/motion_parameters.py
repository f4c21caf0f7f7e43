"""What a blended motion does: its speed, turning, jump height and length, and where it reaches."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from reperform.nodes.kernels.ground_plane import rotate_ground
from reperform.nodes.kernels.root_frame import travel

Parameter = Literal["speed", "turning", "height", "length", "reach_x", "reach_y", "reach_z", "reach_width"]
UNITS: dict[str, str] = {
    "speed": "m/s", "turning": "rad/s", "height": "m", "length": "m", "reach_x": "m", "reach_y": "m", "reach_z": "m",
    "reach_width": "m",
}  # fmt: skip


class Travelled(NamedTuple):
    """What of each input the parameters are read from; all of it blends linearly."""

    # (N, K, 3) steps of the root and (N, K) seconds, from each pose to the next
    motion: np.ndarray
    seconds: np.ndarray
    # (N, K) height of the mean vertex, m
    rise: np.ndarray


def measure(
    parameter: str, travelled: Travelled, weights: np.ndarray, reached: np.ndarray, pose: int
) -> np.ndarray:
    """One parameter of blends with weights (S, N): (S,), by name.

    speed: length of the way over one run, m/s; the way is the arc of the circle that joins both ends and turns as
    much as the body, so sway does not lengthen it.  turning: turn over duration, rad/s, left positive.
    height: greatest rise of the mean vertex over its first height, m.  length: distance of both ends, m.
    reach_x, _y, _z: where the marked vertex is at its pose, from the root at the first pose, m; reached (S, 3): the
    same in the frame of the root at that pose. reach_width is told by two vertices, not by this.
    """
    steps = np.tensordot(weights, travelled.motion, 1)
    seconds = (weights @ travelled.seconds).sum(axis=1)
    track, yaw = travel(steps)
    turned, chord = yaw[:, -1], np.linalg.norm(track[:, -1], axis=1)
    if parameter == "speed":
        return np.asarray(chord / np.sinc(turned / (2 * np.pi)) / seconds)
    if parameter == "turning":
        return np.asarray(turned / seconds)
    if parameter == "height":
        rise = weights @ travelled.rise
        return np.asarray(rise.max(axis=1) - rise[:, 0])
    if parameter == "length":
        return chord
    ground = track[:, pose] + rotate_ground(reached[:, [0, 2]], yaw[:, pose])
    return {"reach_x": ground[:, 0], "reach_y": reached[:, 1], "reach_z": ground[:, 1]}[parameter]
