"""What a motion prescribes over time, and the bone rotations that carry it out."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.rotation import exp
from reperform.nodes.studio.actor_skeleton import (
    BALL_HEIGHT,
    BONE,
    HEEL_BEHIND_BALL,
    NAMES,
    PARENTS,
    REST_JOINTS,
)

# legs are never drawn quite straight: knees would lock and snap
LONGEST_REACH = 0.994
_X, _Y, _Z = np.eye(3)


class Plan(NamedTuple):
    """A motion at N instants, in the frame of the reference stature. Pairs are (left, right); angles in
    radians.

    track (N, 2): ground x, z of the hips; heading (N,): yaw of the whole body, 0 facing +z, positive to the
    left; rise (N,): hips above their rest height; hips, spine, head (N, 3): (forward, left turn, lean right
    down) of each; arms (N, 2, 4): forward swing, raise to the side, twist, elbow; ball (N, 2, 3): where the
    ball of each foot would touch the ground (y: height over it); foot_yaw, foot_pitch (N, 2): toe up
    positive; planted (N, 2).
    """

    track: np.ndarray
    heading: np.ndarray
    rise: np.ndarray
    hips: np.ndarray
    spine: np.ndarray
    head: np.ndarray
    arms: np.ndarray
    ball: np.ndarray
    foot_yaw: np.ndarray
    foot_pitch: np.ndarray
    planted: np.ndarray


def about(axis: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Rotations (N, 3, 3) about one axis by angles (N,)."""
    return exp(np.asarray(angle)[..., None] * axis)


def solve(plan: Plan) -> tuple[np.ndarray, np.ndarray]:
    """(rotation (N, B, 3, 3) rest -> posed of every bone, joints (N, B, 3)); planted feet are kept where
    they are.
    """
    count = len(plan.track)
    rotation = np.tile(np.eye(3), (count, len(NAMES), 1, 1))
    facing = about(_Y, plan.heading)
    hips = facing @ _bend(plan.hips)
    rotation[:, BONE["hips"]] = hips
    # The upper body turns with the heading and carries a part of the hips' own tilt.
    trunk = facing @ _bend(0.5 * plan.hips + 0.5 * plan.spine)
    chest = facing @ _bend(plan.hips * np.array([1.0, 0.0, 0.0]) + plan.spine)
    rotation[:, BONE["spine"]], rotation[:, BONE["chest"]] = trunk, chest
    neck = facing @ _bend(0.4 * plan.spine * np.array([1, 1, 1.0]) + 0.6 * plan.head)
    rotation[:, BONE["neck"]], rotation[:, BONE["head"]] = neck, facing @ _bend(plan.head)
    for side, prefix in enumerate(("left_", "right_")):
        _pose_arm(rotation, plan.arms[:, side], chest, prefix, 1.0 if side == 0 else -1.0)
    feet = _feet(plan)
    ankles = feet[0]
    root = np.column_stack([plan.track[:, 0], REST_JOINTS[0, 1] + plan.rise, plan.track[:, 1]])
    root[:, 1] = _reachable_height(root, hips, ankles)
    for side, prefix in enumerate(("left_", "right_")):
        _pose_leg(rotation, root, hips, ankles[:, side], feet[1][:, side], plan.foot_yaw[:, side], prefix)
        rotation[:, BONE[prefix + "foot"]] = feet[1][:, side]
        rotation[:, BONE[prefix + "toe"]] = feet[2][:, side]
    return rotation, forward_joints(rotation, root)


def forward_joints(rotation: np.ndarray, root: np.ndarray) -> np.ndarray:
    """Joint positions (N, B, 3) from global bone rotations and the root's position."""
    joints = np.empty((*rotation.shape[:2], 3))
    joints[:, 0] = root
    for bone in range(1, len(PARENTS)):
        parent = PARENTS[bone]
        joints[:, bone] = joints[:, parent] + rotation[:, parent] @ (REST_JOINTS[bone] - REST_JOINTS[parent])
    return joints


def _bend(angles: np.ndarray) -> np.ndarray:
    return about(_Y, angles[:, 1]) @ about(_X, angles[:, 0]) @ about(_Z, angles[:, 2])


def _pose_arm(rotation: np.ndarray, arm: np.ndarray, chest: np.ndarray, prefix: str, sign: float) -> None:
    shoulder, elbow = REST_JOINTS[BONE[prefix + "arm"]], REST_JOINTS[BONE[prefix + "forearm"]]
    along = (elbow - shoulder) / np.linalg.norm(elbow - shoulder)
    rest_raise = np.arctan2(abs(along[0]), -along[1])
    hinge = np.cross(along, _Z)
    # the collar follows a raised arm
    lift = np.clip(arm[:, 1] - 0.9, 0, 1.5) * 0.35 + np.clip(arm[:, 0] - 1.2, 0, 2) * 0.15
    collar = chest @ about(_Z, sign * lift)
    upper = (
        chest
        @ about(_X, -arm[:, 0])
        @ about(_Z, sign * (arm[:, 1] - rest_raise))
        @ about(along, sign * arm[:, 2])
    )
    forearm = upper @ about(hinge, arm[:, 3])
    rotation[:, BONE[prefix + "collar"]] = collar
    rotation[:, BONE[prefix + "arm"]] = upper
    rotation[:, BONE[prefix + "forearm"]] = forearm
    rotation[:, BONE[prefix + "hand"]] = forearm @ about(hinge, np.full(len(arm), 0.12))


def _feet(plan: Plan) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Ankle positions (N, 2, 3), foot and toe rotations (N, 2, 3, 3).

    A foot with its toes up turns about the heel, one with its heel up about the ball, where the toes stay
    flat.
    """
    count = len(plan.track)
    ankles, foot, toe = np.empty((count, 2, 3)), np.empty((count, 2, 3, 3)), np.empty((count, 2, 3, 3))
    for side, prefix in enumerate(("left_", "right_")):
        pitch, yaw = plan.foot_pitch[:, side], about(_Y, plan.foot_yaw[:, side])
        foot[:, side] = yaw @ about(_X, -pitch)
        airborne = np.clip(plan.ball[:, side, 1] / 0.06, 0, 1)
        toe[:, side] = yaw @ about(_X, -np.where(pitch > 0, pitch, 0.75 * pitch * airborne))
        heel = np.array([0.0, -BALL_HEIGHT, -HEEL_BEHIND_BALL])
        ball = plan.ball[:, side] + np.array([0, BALL_HEIGHT, 0])
        on_heel = ball + yaw @ heel - foot[:, side] @ heel
        ball = np.where((pitch > 0)[:, None], on_heel, ball)
        ankles[:, side] = ball + foot[:, side] @ (
            REST_JOINTS[BONE[prefix + "foot"]] - REST_JOINTS[BONE[prefix + "toe"]]
        )
    return ankles, foot, toe


def _leg_lengths(prefix: str) -> tuple[float, float]:
    hip, knee, ankle = (REST_JOINTS[BONE[prefix + name]] for name in ("thigh", "shin", "foot"))
    return float(np.linalg.norm(knee - hip)), float(np.linalg.norm(ankle - knee))


def _reachable_height(root: np.ndarray, hips: np.ndarray, ankles: np.ndarray) -> np.ndarray:
    """Height of the hips, lowered (smoothly) to where both legs reach their ankles."""
    height = root[:, 1].copy()
    for side, prefix in enumerate(("left_", "right_")):
        reach = LONGEST_REACH * sum(_leg_lengths(prefix))
        socket = hips @ (REST_JOINTS[BONE[prefix + "thigh"]] - REST_JOINTS[0])
        flat = ankles[:, side, [0, 2]] - root[:, [0, 2]] - socket[:, [0, 2]]
        limit = ankles[:, side, 1] + np.sqrt(np.maximum(reach**2 - (flat**2).sum(1), 0.01)) - socket[:, 1]
        soft = 0.012
        gap = np.maximum(soft - np.abs(height - limit), 0)
        height = np.minimum(height, limit) - gap * gap * (0.25 / soft)
    return height


def _pose_leg(
    rotation: np.ndarray, root: np.ndarray, hips: np.ndarray, ankle: np.ndarray, foot: np.ndarray, yaw: np.ndarray,
    prefix: str,
) -> None:  # fmt: skip
    """Two-bone leg in closed form; the knee bends towards the mean of where hips and foot point."""
    upper, lower = _leg_lengths(prefix)
    socket = root + hips @ (REST_JOINTS[BONE[prefix + "thigh"]] - REST_JOINTS[0])
    line = ankle - socket
    distance = np.linalg.norm(line, axis=1)
    line = line / distance[:, None]
    distance = np.clip(distance, 0.25 * (upper + lower), 0.9995 * (upper + lower))
    forward = hips @ _Z + about(_Y, yaw) @ _Z
    pole = forward - (forward * line).sum(1, keepdims=True) * line
    pole /= np.linalg.norm(pole, axis=1, keepdims=True)
    along = (upper**2 - lower**2 + distance**2) / (2 * distance)
    out = np.sqrt(np.maximum(upper**2 - along**2, 0))
    knee = along[:, None] * line + out[:, None] * pole
    hinge = np.cross(pole, line)
    names = ("thigh", "shin", "foot")
    rest = [REST_JOINTS[BONE[prefix + name]] for name in names]
    rotation[:, BONE[prefix + "thigh"]] = _swing(rest[1] - rest[0], knee, hinge)
    rotation[:, BONE[prefix + "shin"]] = _swing(rest[2] - rest[1], distance[:, None] * line - knee, hinge)


def _swing(rest: np.ndarray, posed: np.ndarray, hinge: np.ndarray) -> np.ndarray:
    """Rotations that take `rest` to `posed` and the rest hinge (x) to `hinge`."""
    a = _frame(rest[None], _X[None])
    return _frame(posed, hinge) @ np.swapaxes(a, 1, 2)


def _frame(axis: np.ndarray, hinge: np.ndarray) -> np.ndarray:
    axis = axis / np.linalg.norm(axis, axis=1, keepdims=True)
    hinge = hinge - (hinge * axis).sum(1, keepdims=True) * axis
    hinge = hinge / np.linalg.norm(hinge, axis=1, keepdims=True)
    return np.stack([axis, hinge, np.cross(axis, hinge)], axis=-1)
