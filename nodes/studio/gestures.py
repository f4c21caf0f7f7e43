"""Motions on the spot and jumps: what the actor does from a stand, back to a stand."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from reperform.nodes.studio.actor_skeleton import BONE
from reperform.nodes.studio.gait import smoothstep
from reperform.nodes.studio.pose_plan import Plan, solve

GRAVITY = 9.81
Keys = Sequence[tuple[float, float]]


def curve(time: np.ndarray, keys: Keys) -> np.ndarray:
    """A monotone smooth curve through (time, value) keys, constant outside them."""
    at, values = np.array(keys, float).T
    return PchipInterpolator(at, values)(np.clip(time, at[0], at[-1]))


def jump(stand: Plan, time: np.ndarray, seconds: float, height: float, length: float) -> Plan:
    """Hips rise `height` (m) above take-off, feet land `length` (m) ahead; the flight is ballistic.

    Raises ValueError where the take is too short for crouch, flight and recovery.
    """
    flight = 2 * np.sqrt(2 * height / GRAVITY)
    speed = 0.5 * GRAVITY * flight
    crouch = 0.10 + 0.30 * min(height, 0.5) + 0.04 * length
    push = 2.1 * crouch / speed
    needed = flight + 2 * push + 0.5
    if seconds < needed:
        raise ValueError(
            f"studio.perform: a jump {height:.2f} m high needs at least {needed:.2f} s, got {seconds:.2f} s: raise seconds"
        )
    off = 0.5 * (seconds - flight)
    land = off + flight
    settle = min(0.45, seconds - land - push)
    before = CubicHermiteSpline([off - push, off], [-crouch, 0.0], [0.0, speed])
    after = CubicHermiteSpline([land, land + push], [0.0, -0.85 * crouch], [-speed, 0.0])
    s = np.clip(time - off, 0, flight)
    airborne = (time > off) & (time < land)
    ballistic = speed * s - 0.5 * GRAVITY * s * s
    rise = np.select(
        [time < off - push, time < off, time <= land, time < land + push],
        [
            -crouch * smoothstep((time - 0.0) / (off - push)),
            before(np.clip(time, off - push, off)),
            ballistic,
            after(np.clip(time, land, land + push)),
        ],
        -0.85 * crouch * (1 - smoothstep((time - land - push) / settle)),
    )
    forward = length / (flight + push)
    along = forward * np.interp(
        time, [off - push, off, land, land + push], [0, 0.5 * push, 0.5 * push + flight, push + flight]
    )
    along = np.where(
        (time > off - push) & (time < off),
        0.5 * forward * np.clip(time - off + push, 0, push) ** 2 / push,
        np.where(
            (time > land) & (time < land + push),
            forward * (push + flight) - 0.5 * forward * np.clip(land + push - time, 0, push) ** 2 / push,
            along,
        ),
    )
    tuck = (0.05 + 0.12 * length) * np.sin(np.pi * s / flight) ** 2
    ball = stand.ball.copy()
    ball[..., 2] += (length * smoothstep((time - off) / flight))[:, None]
    ball[..., 1] = np.where(airborne, ballistic + tuck, 0)[:, None]
    point = 0.95 * smoothstep((time - off + 0.6 * push) / (0.6 * push + 0.03))
    point *= 1 - smoothstep((time - off - 0.25 * flight) / (0.72 * flight))
    arms = stand.arms.copy()
    high = 1.3 + 2.2 * min(height, 0.5) + 0.3 * length
    swing = curve(
        time,
        [
            (0, 0),
            (off - push - 0.10, -0.75),
            (off + 0.14, high),
            (max(land, off + 0.24), 0.7),
            (max(land, off + 0.24) + push, 0.2),
            (land + push + settle, 0),
        ],
    )
    arms[:, :, 0] += swing[:, None]
    arms[:, :, 3] += np.clip(0.35 * swing, 0, 0.6)[:, None]
    lean = curve(
        time,
        [
            (0, 0),
            (off - push, 0.55),
            (off, 0.05 + 0.15 * length),
            (land, 0.15),
            (land + push, 0.5),
            (land + push + settle, 0),
        ],
    )
    planted = np.repeat((~airborne)[:, None], 2, axis=1)
    return stand._replace(
        rise=stand.rise + rise + 0.035 * (point > 0) * point,
        track=stand.track + np.column_stack([np.zeros_like(time), along]),
        ball=ball,
        foot_pitch=np.repeat(-point[:, None], 2, axis=1),
        hips=stand.hips + np.column_stack([0.7 * lean, 0 * lean, 0 * lean]),
        spine=stand.spine + np.column_stack([0.6 * lean, 0 * lean, 0 * lean]),
        head=stand.head + np.column_stack([0.15 * lean, 0 * lean, 0 * lean]),
        arms=arms,
        planted=planted,
    )  # fmt: skip


def reach_high(stand: Plan, time: np.ndarray, seconds: float, amount: float) -> Plan:
    """The right hand goes up, the eyes follow, then the heels rise; amount in [0, 1]."""
    go = there_and_back(time, seconds, 0.42)
    arms = stand.arms.copy()
    arms[:, 1, 0] += amount * 2.75 * go
    arms[:, 1, 1] += 0.18 * np.sin(np.pi * go) * amount
    arms[:, 1, 3] += 0.75 * np.sin(np.pi * go)
    arms[:, 1, 3] *= 1 - 0.8 * go * amount
    tip = np.clip(amount * 1.5 - 0.5, 0, 1) * go
    zero = np.zeros_like(go)
    return stand._replace(
        arms=arms,
        rise=stand.rise + 0.075 * tip,
        foot_pitch=np.repeat(-0.55 * tip[:, None], 2, axis=1),
        hips=stand.hips + np.column_stack([-0.04 * go, zero, 0.05 * tip]),
        spine=stand.spine + np.column_stack([-0.10 * go * amount, 0.22 * go * amount, 0.10 * go * amount]),
        head=stand.head + np.column_stack([-0.45 * go * amount, -0.10 * go, zero]),
    )


def reach_low(stand: Plan, time: np.ndarray, seconds: float, amount: float) -> Plan:
    """The actor bends knees and back and reaches for the floor with the right hand; amount in [0, 1]."""
    go = there_and_back(time, seconds, 0.46)
    bend = amount * go
    zero = np.zeros_like(go)
    arms = stand.arms.copy()
    arms[:, 1, 0] += 1.15 * bend + 0.25 * go
    arms[:, 0, 0] += 0.75 * bend
    arms[:, 1, 3] *= 1 - 0.7 * go
    return stand._replace(
        arms=arms,
        rise=stand.rise - 0.34 * bend**1.3,
        track=stand.track + np.column_stack([zero, -0.10 * bend]),
        hips=stand.hips + np.column_stack([0.62 * bend, zero, zero]),
        spine=stand.spine + np.column_stack([0.62 * bend, 0.25 * bend, zero]),
        head=stand.head + np.column_stack([0.55 * bend, zero, zero]),
    )


def punch(stand: Plan, time: np.ndarray, seconds: float, amount: float) -> Plan:
    """Guard, a straight right with the hips behind it, guard again; amount raises the fist, [0, 1]."""
    guard = smoothstep(time / (0.25 * seconds)) * smoothstep((seconds - time) / (0.25 * seconds))
    hit = curve(
        time,
        [
            (0.34 * seconds, 0),
            (0.42 * seconds, -0.18),
            (0.52 * seconds, 1),
            (0.56 * seconds, 1),
            (0.74 * seconds, 0),
        ],
    )
    arms = stand.arms.copy()
    for side in (0, 1):
        arms[:, side, 0] += 0.55 * guard
        arms[:, side, 2] += 0.25 * guard
        arms[:, side, 3] += 1.75 * guard
    arms[:, 1, 0] += hit * (0.55 + 0.75 * amount)
    arms[:, 1, 2] *= 1 - 0.6 * np.clip(hit, 0, 1)
    arms[:, 1, 3] -= 1.85 * np.clip(hit, -0.2, 1)
    zero = np.zeros_like(hit)
    return stand._replace(
        arms=arms,
        rise=stand.rise - 0.045 * guard,
        track=stand.track + np.column_stack([zero, 0.08 * hit]),
        hips=stand.hips + np.column_stack([0.06 * guard, 0.30 * hit, zero]),
        spine=stand.spine + np.column_stack([0.08 * guard, 0.62 * hit, zero]),
        head=stand.head + np.column_stack([0.06 * guard, 0.05 * hit, zero]),
    )


def duck(stand: Plan, time: np.ndarray, seconds: float, amount: float) -> Plan:
    """Down under something and up again; amount in [0, 1]."""
    go = there_and_back(time, seconds, 0.42) * amount
    zero = np.zeros_like(go)
    arms = stand.arms.copy()
    arms[:, :, 0] += (0.55 * go)[:, None]
    arms[:, :, 3] += (1.1 * go)[:, None]
    return stand._replace(
        arms=arms,
        rise=stand.rise - 0.42 * go,
        track=stand.track + np.column_stack([zero, -0.13 * go]),
        hips=stand.hips + np.column_stack([0.45 * go, zero, zero]),
        spine=stand.spine + np.column_stack([0.75 * go, zero, zero]),
        head=stand.head + np.column_stack([0.35 * go, zero, zero]),
        foot_pitch=np.repeat(-0.25 * go[:, None], 2, axis=1),
    )


def dance(stand: Plan, time: np.ndarray, seconds: float, amount: float) -> Plan:
    """Side steps and waving arms, 1.8 beats a second, that begin and end standing; amount scales it, [0, 1]."""
    envelope = amount * smoothstep(time / 0.5) * smoothstep((seconds - time) / 0.5)
    beats = 0.9 * time
    bar = beats - np.floor(beats)
    step = 0.20 * amount
    inside = (beats >= 0) & (np.floor(beats) < np.floor(0.9 * seconds))
    ball = stand.ball.copy()
    for side, out, back in ((0, 0.02, 0.75), (1, 0.27, 0.50)):
        s_out, s_back = np.clip((bar - out) / 0.20, 0, 1), np.clip((bar - back) / 0.20, 0, 1)
        shift = step * (smoothstep(s_out) - smoothstep(s_back)) * inside
        lift = 0.07 * 16 * ((s_out * (1 - s_out)) ** 2 + (s_back * (1 - s_back)) ** 2) * inside
        ball[:, side, 0] += shift
        ball[:, side, 1] += lift
    aside = 0.5 * (ball[:, 0, 0] + ball[:, 1, 0]) - 0.5 * (stand.ball[:, 0, 0] + stand.ball[:, 1, 0])
    planted = ball[..., 1] < 1e-9
    w = 2 * np.pi * beats
    sway = 0.05 * envelope * np.sin(w + 0.6)
    arms = stand.arms.copy()
    for side, delay in ((0, 0.0), (1, 2.1)):
        arms[:, side, 0] += envelope * (0.75 + 0.65 * np.sin(w + delay))
        arms[:, side, 1] += envelope * (0.75 + 0.45 * np.sin(0.5 * w + 1.3 * delay))
        arms[:, side, 3] += envelope * (0.7 + 0.5 * np.sin(w + delay + 1.1))
    smooth = _moving_mean(aside, 31)
    bend, turn, lean = np.cos(2 * w), np.sin(w), np.sin(w + 0.6)
    return stand._replace(
        ball=ball,
        planted=planted,
        arms=arms,
        rise=stand.rise - envelope * (0.035 + 0.022 * np.cos(2 * w)),
        track=stand.track + np.column_stack([smooth + sway, np.zeros_like(sway)]),
        hips=stand.hips + envelope[:, None] * np.column_stack([0.03 * bend, 0.22 * turn, 0.10 * lean]),
        spine=stand.spine + envelope[:, None] * np.column_stack([0.05 * bend, -0.24 * np.sin(w + 0.5), -0.14 * lean]),
        head=stand.head + envelope[:, None] * np.column_stack([0.06 * bend, 0.18 * np.sin(0.5 * w), 0.08 * turn]),
    )  # fmt: skip


def amount_for(
    gesture: Callable[[float], Plan], bone: str, height: float, highest: bool, what: str, frames: np.ndarray
) -> float:
    """The amount in [0, 1] at which a joint's extreme height over the take is `height` (m).

    Raises ValueError with the range where it cannot be reached.
    """

    def extreme(amount: float) -> float:
        plan = gesture(amount)
        part = plan._replace(**{name: values[frames] for name, values in plan._asdict().items()})
        level = solve(part)[1][:, BONE[bone], 1]
        return float(level.max() if highest else level.min())

    return amount_that_gives(extreme, height, what)


def amount_that_gives(measure: Callable[[float], float], wanted: float, what: str) -> float:
    """The amount in [0, 1] at which a monotone measure (m) is as wanted, by bisection.

    Raises ValueError with the range where it cannot be reached.
    """
    low, high = measure(0.0), measure(1.0)
    if not min(low, high) <= wanted <= max(low, high):
        raise ValueError(
            f"studio.perform: {what} must be {min(low, high):.2f} .. {max(low, high):.2f} m for an actor of the "
            f"reference stature, got {wanted:.2f} m: choose a {what} in this range, or 0 for the motion's own"
        )
    lower, upper = 0.0, 1.0
    for _ in range(14):
        middle = 0.5 * (lower + upper)
        if (measure(middle) < wanted) == (high > low):
            lower = middle
        else:
            upper = middle
    return 0.5 * (lower + upper)


def there_and_back(time: np.ndarray, seconds: float, peak: float) -> np.ndarray:
    """0 at both ends of the take, 1 round the time peak * seconds."""
    out = smoothstep((time / seconds - 0.06) / (peak - 0.06))
    return np.clip(out * (1 - smoothstep((time / seconds - peak - 0.10) / (0.84 - peak))), 0, 1)


def _moving_mean(values: np.ndarray, width: int) -> np.ndarray:
    padded = np.pad(values, width // 2, mode="edge")
    return np.convolve(padded, np.full(width, 1 / width), mode="valid")
