"""Skeletons as solid bones: left blue, right red."""

from __future__ import annotations

import re

import numpy as np

from reperform.nodes.products.mocap import Mocap, SkeletalAnimation
from reperform.nodes.products.performance import SkeletonSequence
from reperform.viewer.palette import STATIONS, rgb, tint
from reperform.viewer.pictures.look import Look
from reperform.viewer.pictures.scene import Body, draw_scene, ground_under
from reperform.viewer.pictures.solids import ball, joined, tube

COLOURS = {"left": STATIONS["texture"], "right": STATIONS["blend"], "middle": tint(STATIONS["evaluate"], 0.3)}


def skeleton_picture(product: SkeletonSequence, frame: int, look: Look) -> np.ndarray:
    """One frame of a skeleton on the ground."""
    bodies = skeleton_bodies(product, frame)
    joints = np.asarray(product.joints[frame])
    return draw_scene(bodies, look.view, look.size, ground=ground_under(joints))


def mocap_picture(product: Mocap, frame: int, look: Look) -> np.ndarray:
    """One frame of motion capture."""
    return skeleton_picture(product.skeleton, frame, look)


def skeletal_animation_picture(product: SkeletalAnimation, frame: int, look: Look) -> np.ndarray:
    """One frame of synthesised skeletal motion."""
    return skeleton_picture(product.mocap.skeleton, frame, look)


def skeleton_bodies(product: SkeletonSequence, frame: int) -> list[Body]:
    """Bones and joints of one frame as meshes, by side of the body."""
    joints = np.asarray(product.joints[frame], np.float64)
    names, parents = np.asarray(product.names).tolist(), np.asarray(product.parents).tolist()
    size = float(np.ptp(joints, axis=0).max()) if len(joints) else 1.0
    parts: dict[str, list[tuple[np.ndarray, np.ndarray]]] = {side: [] for side in COLOURS}
    for name, parent, joint in zip(names, parents, joints, strict=True):
        side = _paired_side(name, names)
        parts[side].append(ball(joint, 0.013 * size))
        if parent >= 0:
            parts[side].append(tube(joints[parent], joint, 0.011 * size, 0.006 * size))
    return [
        Body(*joined(parts[side]), colour=np.array(rgb(colour)) / 255)
        for side, colour in COLOURS.items()
        if parts[side]
    ]


def side_of(name: str) -> str:
    """The side of the body a joint's name tells: left, right or middle."""
    if re.search(r"left|(^|[_.\- ])l($|[_.\- ])|^l(?=[A-Z])", name) or name.startswith("Left"):
        return "left"
    if re.search(r"right|(^|[_.\- ])r($|[_.\- ])|^r(?=[A-Z])", name) or name.startswith("Right"):
        return "right"
    return "middle"


def _paired_side(name: str, names: list[str]) -> str:
    """The side that a name tells, or that it tells beside its twin, as lfemur beside rfemur."""
    for letter, twin, side in (
        ("l", "r", "left"),
        ("L", "R", "left"),
        ("r", "l", "right"),
        ("R", "L", "right"),
    ):
        if name.startswith(letter) and twin + name[1:] in names:
            return side
    return side_of(name)
