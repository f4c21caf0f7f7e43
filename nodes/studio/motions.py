"""The actor's repertoire: every motion as a plan sampled finely, with time before and after the take."""

from __future__ import annotations

from typing import Literal

import numpy as np

from reperform.nodes.studio.gait import RESTING_PHASE, locomotion, smoothstep, style_at
from reperform.nodes.studio.pose_plan import Plan

Motion = Literal[
    "stand", "walk", "jog", "turn_left", "turn_right", "stand_to_walk", "walk_to_stand", "walk_to_jog", "jog_to_walk",
]  # fmt: skip
# samples per second of the plan, and the seconds planned before and after the take
RATE = 200
MARGIN = 3.0


def plan_motion(
    motion: Motion, seconds: float, walk: float, jog: float, turn: float, phase: float
) -> tuple[Plan, np.ndarray]:
    """(plan, its times in s: from -MARGIN to seconds + MARGIN)."""
    time = np.arange(-round(MARGIN * RATE), round((seconds + MARGIN) * RATE) + 1) / RATE
    start = round(MARGIN * RATE)
    speed = _speed(motion, time, seconds, walk, jog)
    rate = {"turn_left": turn, "turn_right": -turn}.get(motion, 0.0)
    if motion == "walk_to_stand":
        stop = int(np.argmax(time >= seconds))
        phase = _phase_that_stops(speed, start, stop, phase)
    elif motion in ("stand", "stand_to_walk"):
        phase = RESTING_PHASE
    return locomotion(time, speed, np.full(len(time), rate), phase, start), time


def _speed(motion: Motion, time: np.ndarray, seconds: float, walk: float, jog: float) -> np.ndarray:
    """Speed over time (m/s); transitions keep a fifth of the take at either end steady."""
    change = smoothstep((time / seconds - 0.15) / 0.6)
    match motion:
        case "stand":
            return np.zeros_like(time)
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
    raise ValueError(f"studio.perform: unknown motion {motion!r}")


def _phase_that_stops(speed: np.ndarray, start: int, stop: int, wanted: float) -> float:
    """The phase at the take's start nearest `wanted` that ends with both feet on the ground, just planted."""
    cadence = style_at(speed).cadence[start : stop + 1]
    advance = float((0.5 * (cadence[1:] + cadence[:-1])).sum() / RATE)
    exact = RESTING_PHASE - advance
    return exact + 0.5 * round((wanted - exact) / 0.5)
