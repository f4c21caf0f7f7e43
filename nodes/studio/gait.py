"""Standing, walking, jogging and everything between, with planned footsteps."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reperform.nodes.studio.pose_plan import Plan

# where the cycle rests while the actor stands: one foot has just been planted, the other is about to leave
RESTING_PHASE = 0.06
STAND_HALF_WIDTH = 0.115
_DEGREE = np.pi / 180


class Style(NamedTuple):
    """Gait quantities at speed (m/s); amplitudes in radians and metres."""

    cadence: np.ndarray
    duty: np.ndarray
    ahead: np.ndarray
    half_width: np.ndarray
    lift: np.ndarray
    strike: np.ndarray
    push: np.ndarray
    sag: np.ndarray
    vault: np.ndarray
    bounce: np.ndarray
    sway: np.ndarray
    hip_turn: np.ndarray
    hip_drop: np.ndarray
    lean: np.ndarray
    twist: np.ndarray
    arm: np.ndarray
    arm_base: np.ndarray
    elbow: np.ndarray
    elbow_swing: np.ndarray
    arm_side: np.ndarray


_SPEED = (0.0, 0.15, 0.4, 0.8, 1.4, 2.0, 2.6, 3.6)
_TABLE = Style(*(np.array(row) for row in dict(
    cadence=(0.0, 0.55, 0.80, 0.90, 1.00, 1.22, 1.38, 1.50),
    duty=(0.70, 0.68, 0.65, 0.62, 0.58, 0.47, 0.38, 0.34),
    ahead=(0.092, 0.091, 0.088, 0.080, 0.070, 0.030, -0.015, -0.030),
    half_width=(STAND_HALF_WIDTH, 0.105, 0.085, 0.070, 0.055, 0.045, 0.035, 0.030),
    lift=(0.015, 0.020, 0.028, 0.040, 0.050, 0.080, 0.120, 0.160),
    strike=tuple(a * _DEGREE for a in (0, 3, 8, 17, 23, 14, 6, 3)),
    push=tuple(a * _DEGREE for a in (2, 9, 20, 38, 52, 58, 62, 66)),
    sag=(-0.010, -0.012, -0.015, -0.022, -0.028, -0.050, -0.065, -0.075),
    vault=(0.0, 0.002, 0.005, 0.010, 0.016, 0.006, 0.0, 0.0),
    bounce=(0.0, 0.0, 0.0, 0.0, 0.0, 0.016, 0.034, 0.040),
    sway=(0.0, 0.010, 0.022, 0.026, 0.024, 0.016, 0.012, 0.010),
    hip_turn=tuple(a * _DEGREE for a in (0, 1, 2.5, 4, 6, 7, 8, 9)),
    hip_drop=tuple(a * _DEGREE for a in (0, 0.8, 1.8, 3, 4, 4, 4, 4)),
    lean=tuple(a * _DEGREE for a in (0, 0.5, 1.2, 2, 3, 6, 9, 13)),
    twist=tuple(a * _DEGREE for a in (0, 1, 2.5, 5, 8, 11, 13, 15)),
    arm=tuple(a * _DEGREE for a in (0, 3, 8, 15, 25, 32, 38, 44)),
    arm_base=tuple(a * _DEGREE for a in (2, 2, 2, 2, 2, 0, -4, -6)),
    elbow=tuple(a * _DEGREE for a in (14, 14, 15, 18, 24, 58, 84, 92)),
    elbow_swing=tuple(a * _DEGREE for a in (0, 1, 3, 6, 12, 14, 16, 18)),
    arm_side=tuple(a * _DEGREE for a in (14, 14, 14, 14, 14, 17, 19, 20)),
).values()))  # fmt: skip


def style_at(speed: np.ndarray) -> Style:
    """Gait quantities at speeds (N,) by linear interpolation, smoothed by the caller's smooth speeds."""
    return Style(*(np.interp(speed, _SPEED, row) for row in _TABLE))


def smoothstep(x: np.ndarray) -> np.ndarray:
    """0 below 0, 1 above 1, with zero first and second derivatives at both."""
    x = np.clip(x, 0, 1)
    return x * x * x * (x * (6 * x - 15) + 10)


def locomotion(time: np.ndarray, speed: np.ndarray, turn: np.ndarray, phase: float, anchor: int) -> Plan:
    """The plan of moving at `speed` (m/s) and `turn` (rad/s, left positive), sampled at `time` (N,),
    uniform.

    The gait cycle is at `phase` (0: the left heel strikes) at sample `anchor`. Each foot is planted where
    the hips pass during its stance, so it never slides; in between it swings. At the ends of the time range
    footsteps are guesses: give a second or two more than is used.
    """
    step = float(time[1] - time[0])
    style = style_at(speed)
    cycle = np.concatenate([[0], np.cumsum(0.5 * (style.cadence[1:] + style.cadence[:-1]) * step)])
    cycle += phase - cycle[anchor]
    heading = np.concatenate([[0], np.cumsum(0.5 * (turn[1:] + turn[:-1]) * step)])
    velocity = speed[:, None] * np.column_stack([np.sin(heading), np.cos(heading)])
    track = np.concatenate([np.zeros((1, 2)), np.cumsum(0.5 * (velocity[1:] + velocity[:-1]) * step, axis=0)])
    feet = [_footsteps(cycle + 0.5 * side, style, speed, track, heading, side) for side in (0, 1)]
    ball, yaw, pitch, planted = (np.stack(rows, axis=1) for rows in zip(*feet, strict=True))
    return _body(time, speed, turn, cycle, style, track, heading, ball, yaw, pitch, planted)


def _footsteps(
    cycle: np.ndarray, style: Style, speed: np.ndarray, track: np.ndarray, heading: np.ndarray, side: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Ball position (N, 3), yaw, pitch and contact of one foot."""
    step_index = np.floor(cycle).astype(int)
    part = cycle - step_index
    stance = part < style.duty
    sign = 1.0 if side == 0 else -1.0
    first = step_index[0]
    count = step_index[-1] - first + 1
    place, yaw = np.zeros((count + 1, 2)), np.zeros(count + 1)
    for k in range(count):
        rows = np.flatnonzero((step_index == first + k) & stance)
        if not len(rows):
            rows = np.array([0])
        still = rows[speed[rows] < 0.05]
        rows = still if len(still) else rows
        yaw[k] = heading[rows].mean() + sign * np.interp(speed[rows].mean(), (0, 1.4), (9, 5)) * _DEGREE
        ahead = np.array([np.sin(heading[rows].mean()), np.cos(heading[rows].mean())])
        left = np.array([ahead[1], -ahead[0]])
        half = style.half_width[rows].mean()
        place[k] = track[rows].mean(axis=0) + style.ahead[rows].mean() * ahead + sign * half * left
    place[count], yaw[count] = place[count - 1] + (track[-1] - track[0]) / max(count, 1), yaw[count - 1]
    index = step_index - first
    begin = _stance_end(cycle, style.duty)
    swing = np.where(stance, 0.0, np.clip((cycle - begin) / np.maximum(step_index + 1 - begin, 1e-6), 0, 1))
    move = smoothstep(swing) * 0.55 + 0.45 * (swing * swing * (3 - 2 * swing))
    ground = place[index] + move[:, None] * (place[index + 1] - place[index])
    height = style.lift * 16 * swing**2 * (1 - swing) ** 2
    turn = yaw[index] + move * (yaw[index + 1] - yaw[index])
    ball = np.column_stack([ground[:, 0], height, ground[:, 1]])
    pitch = _foot_pitch(part, stance, swing, style)
    planted = stance & (pitch <= 0)
    return ball, turn, pitch, planted


def _stance_end(cycle: np.ndarray, duty: np.ndarray) -> np.ndarray:
    """For every sample the cycle value at which the foot left the ground in its current step."""
    leaving = np.floor(cycle) + duty
    airborne = cycle - np.floor(cycle) >= duty
    edge = np.flatnonzero(airborne & ~np.concatenate([[False], airborne[:-1]]))
    held = leaving.copy()
    if len(edge):
        latest = np.searchsorted(edge, np.arange(len(cycle)), side="right") - 1
        held = np.where(latest >= 0, cycle[edge[np.maximum(latest, 0)]], leaving)
    return np.where(airborne, held, leaving)


def _foot_pitch(part: np.ndarray, stance: np.ndarray, swing: np.ndarray, style: Style) -> np.ndarray:
    """Toe up after the heel strikes, flat, heel up to push off, then back through the swing."""
    through = np.clip(part / style.duty, 0, 1)
    strike = style.strike * (1 - smoothstep(through / 0.16))
    push = style.push * smoothstep((through - 0.50) / 0.62) / smoothstep(np.array(0.5 / 0.62))
    in_air = -style.push * (1 - smoothstep(swing / 0.80)) + style.strike * smoothstep((swing - 0.45) / 0.55)
    in_air = in_air - 0.35 * style.bounce / 0.034 * np.sin(np.pi * np.clip(swing / 0.8, 0, 1)) ** 2
    return np.where(stance, np.where(through < 0.4, strike, -push), in_air)


def _body(
    time: np.ndarray, speed: np.ndarray, turn: np.ndarray, cycle: np.ndarray, style: Style, track: np.ndarray,
    heading: np.ndarray, ball: np.ndarray, yaw: np.ndarray, pitch: np.ndarray, planted: np.ndarray,
) -> Plan:  # fmt: skip
    once, twice = 2 * np.pi * cycle, 4 * np.pi * cycle
    idle = 1 - smoothstep(speed / 0.8)
    breath = np.sin(2 * np.pi * 0.28 * time)
    ahead = np.column_stack([np.sin(heading), np.cos(heading)])
    left = np.column_stack([ahead[:, 1], -ahead[:, 0]])
    over = np.sin(once - 0.1 * np.pi)
    aside = style.sway * over + idle * 0.006 * np.sin(2 * np.pi * 0.17 * time)
    rise = style.sag + style.vault * np.cos(twice - 1.2 * np.pi) - style.bounce * np.cos(twice - 0.8 * np.pi)
    zero = np.zeros_like(time)
    # into the curve
    tilt = -np.arctan(speed * turn / 9.81) * 0.7
    hips = np.column_stack([style.lean * 0.6, -style.hip_turn * np.cos(once), style.hip_drop * over + tilt])
    spine = np.column_stack(
        [
            style.lean * 0.5 + idle * 0.012 * breath,
            style.twist * np.cos(once) + 0.08 * turn,
            -0.35 * style.hip_drop * over + tilt,
        ]
    )
    head = np.column_stack(
        [0.25 * style.lean - 0.01 * np.cos(twice) + 0.01 * idle * breath, 0.14 * turn, zero + 0.3 * tilt]
    )
    arms = np.empty((len(time), 2, 4))
    for side, sign in enumerate((-1.0, 1.0)):
        swing = sign * np.cos(once - 0.12)
        arms[:, side, 0] = style.arm_base + style.arm * swing
        arms[:, side, 1] = style.arm_side + 0.02 * idle * breath
        arms[:, side, 2] = 0.25 + 0.5 * np.clip(style.elbow - 0.5, 0, 1)
        arms[:, side, 3] = style.elbow + style.elbow_swing * swing
    return Plan(
        track + aside[:, None] * left, heading, rise, hips, spine, head, arms, ball, yaw, pitch, planted
    )
