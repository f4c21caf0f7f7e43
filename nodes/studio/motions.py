"""The actor's repertoire: every motion as a plan sampled finely, with time before and after the take."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np

from reperform.nodes.studio import gestures
from reperform.nodes.studio.gait import RESTING_PHASE, locomotion, smoothstep, style_at
from reperform.nodes.studio.grab import grab
from reperform.nodes.studio.pose_plan import Plan

Motion = Literal[
    "stand", "walk", "jog", "turn_left", "turn_right", "stand_to_walk", "walk_to_stand", "walk_to_jog",
    "jog_to_walk", "jump_high", "jump_low", "jump_long", "jump_short", "reach_high", "reach_low", "grab", "punch",
    "duck", "dance",
]  # fmt: skip
# seconds planned before and after the take, so that footsteps and cloth have a past and a future
MARGIN = 2.0


def plan_motion(
    motion: Motion, seconds: float, rate: float, walk: float, jog: float, turn: float, phase: float, height: float,
    length: float, width: float,
) -> Plan:  # fmt: skip
    """The plan of a take, `rate` samples a second from -MARGIN to seconds + MARGIN.

    Height, length and width are in m at the reference stature; 0: the motion's own.
    """
    start = round(MARGIN * rate)
    time = np.arange(-start, round((seconds + MARGIN) * rate) + 1) / rate
    speed = _speed(motion, time, seconds, walk, jog)
    turning = {"turn_left": turn, "turn_right": -turn}.get(motion, 0.0)
    if motion == "walk_to_stand":
        stop = int(np.argmax(time >= seconds))
        phase = _phase_that_stops(speed[start : stop + 1], rate, phase)
    elif not speed[start] > 0:
        phase = RESTING_PHASE
    plan = locomotion(time, speed, np.full(len(time), turning), phase, start)
    return _gesture(motion, plan, time, seconds, height, length, width)


def _gesture(
    motion: Motion, stand: Plan, time: np.ndarray, seconds: float, height: float, length: float, width: float
) -> Plan:
    """What is done on top of standing; other motions come back as they are."""
    frames = np.flatnonzero((time >= 0) & (time <= seconds))[::4]
    match motion:
        case "jump_high":
            return gestures.jump(stand, time, seconds, height or 0.40, length)
        case "jump_low":
            return gestures.jump(stand, time, seconds, height or 0.16, length)
        case "jump_long":
            return gestures.jump(stand, time, seconds, height or 0.22, length or 1.2)
        case "jump_short":
            return gestures.jump(stand, time, seconds, height or 0.12, length or 0.5)
        case "reach_high":
            return _reaching(gestures.reach_high, stand, time, seconds, "right_hand", height, True, frames)
        case "reach_low":
            return _reaching(gestures.reach_low, stand, time, seconds, "right_hand", height, False, frames)
        case "grab":
            return grab(stand, time, seconds, width)
        case "punch":
            return _reaching(gestures.punch, stand, time, seconds, "right_hand", height, True, frames)
        case "duck":
            return _reaching(gestures.duck, stand, time, seconds, "head", height, False, frames)
        case "dance":
            return gestures.dance(stand, time, seconds, 1.0)
        case _:
            return stand


def _reaching(
    gesture: Callable[[Plan, np.ndarray, float, float], Plan], stand: Plan, time: np.ndarray, seconds: float,
    bone: str, height: float, highest: bool, frames: np.ndarray,
) -> Plan:  # fmt: skip
    if not height:
        return gesture(stand, time, seconds, 1.0)

    def at(amount: float) -> Plan:
        return gesture(stand, time, seconds, amount)

    return at(gestures.amount_for(at, bone, height, highest, "height", frames))


def _speed(motion: Motion, time: np.ndarray, seconds: float, walk: float, jog: float) -> np.ndarray:
    """Speed over time (m/s); transitions keep a fifth of the take at either end steady."""
    change = smoothstep((time / seconds - 0.15) / 0.6)
    match motion:
        case "walk" | "turn_left" | "turn_right":
            return np.full_like(time, walk)
        case "jog":
            return np.full_like(time, jog)
        case "stand_to_walk":
            return walk * change
        case "walk_to_stand":
            return walk * (1 - change)
        case "walk_to_jog":
            return walk + (jog - walk) * change
        case "jog_to_walk":
            return jog + (walk - jog) * change
        case _:
            return np.zeros_like(time)


def _phase_that_stops(speed: np.ndarray, rate: float, wanted: float) -> float:
    """The phase at the take's start nearest `wanted` that ends with both feet on the ground, just planted."""
    cadence = style_at(speed).cadence
    advance = float((0.5 * (cadence[1:] + cadence[:-1])).sum() / rate)
    exact = RESTING_PHASE - advance
    return exact + 0.5 * round((wanted - exact) / 0.5)
