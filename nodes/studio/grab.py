"""Both hands go to the sides of a box, and back."""

from __future__ import annotations

import numpy as np

from reperform.nodes.studio.actor_skeleton import BONE
from reperform.nodes.studio.gestures import amount_that_gives, there_and_back
from reperform.nodes.studio.pose_plan import Plan, solve

# of the take: when the hands have arrived; they rest for a tenth of it
_ARRIVED = 0.44
# arms held out: forward swing, elbow (rad); raise to the side at the narrowest and at the widest
_FORWARD, _ELBOW = 1.05, 0.5
_NARROW, _WIDE = -0.05, 0.85


def grab(stand: Plan, time: np.ndarray, seconds: float, width: float) -> Plan:
    """The hands meet a box `width` (m) wide, between their joints, at the height of the chest; 0: half open.

    Raises ValueError with the range where arms are not long enough, or too long.
    """
    amount = 0.5
    if width:
        arrived = np.array([np.argmin(np.abs(time - (_ARRIVED + 0.05) * seconds))])

        def apart(amount: float) -> float:
            plan = _opened(stand, time, seconds, amount)
            joints = solve(Plan(*(values[arrived] for values in plan)))[1][0]
            return float(np.linalg.norm(joints[BONE["left_hand"]] - joints[BONE["right_hand"]]))

        amount = amount_that_gives(apart, width, "width")
    return _opened(stand, time, seconds, amount)


def _opened(stand: Plan, time: np.ndarray, seconds: float, amount: float) -> Plan:
    go = there_and_back(time, seconds, _ARRIVED)
    out = np.array([_FORWARD, _NARROW + amount * (_WIDE - _NARROW), 0.25, _ELBOW])
    # hands open a little wider on their way, as they go round the box
    way = 0.12 * np.sin(np.pi * go)
    arms = stand.arms + go[:, None, None] * (out - stand.arms)
    arms[:, :, 1] += way[:, None]
    zero = np.zeros_like(go)
    return stand._replace(
        arms=arms,
        rise=stand.rise - 0.05 * go,
        track=stand.track + np.column_stack([zero, -0.02 * go]),
        hips=stand.hips + np.column_stack([0.10 * go, zero, zero]),
        spine=stand.spine + np.column_stack([0.16 * go, zero, zero]),
        head=stand.head + np.column_stack([0.22 * go, zero, zero]),
    )
