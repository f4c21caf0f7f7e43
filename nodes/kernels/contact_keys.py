"""Key frames from foot contacts: the moments that must coincide when motions are brought into step."""

from __future__ import annotations

import numpy as np


def contact_events(planted: np.ndarray) -> list[tuple[float, str]]:
    """(frame, event) in time: `left down`, `left up`, `right down`, `right up`; half-way between two frames.

    planted: (T, 2) bool. Gaps of a single frame are not events.
    """
    events = []
    for foot, name in enumerate(("left", "right")):
        held = _without_blinks(np.asarray(planted)[:, foot])
        for frame in np.flatnonzero(held[1:] != held[:-1]).tolist():
            events.append((frame + 0.5, f"{name} {'down' if held[frame + 1] else 'up'}"))
    return sorted(events)


def common_keys(events: list[list[tuple[float, str]]]) -> np.ndarray:
    """Moments (takes, K) of the events that all takes share, in the same order; (takes, 0) where they do not.

    All events if their order agrees, else only those of feet coming down (a walk lifts a foot after the other came
    down, a run before), else only those of the left foot.
    """
    for kept in (("down", "up"), ("down",), ("left down",)):
        chosen = [[(t, what) for t, what in take if what.endswith(kept)] for take in events]
        orders = {_order(take) for take in chosen}
        if len(orders) == 1 and orders != {()}:
            return np.array([[t for t, _ in _merged(take)] for take in chosen])
    return np.zeros((len(events), 0))


def _order(events: list[tuple[float, str]]) -> tuple[str, ...]:
    return tuple(what for _, what in _merged(events))


def _merged(events: list[tuple[float, str]]) -> list[tuple[float, str]]:
    """Events of both feet at one moment as one, so that their order does not matter."""
    merged: list[tuple[float, str]] = []
    for t, what in events:
        if merged and merged[-1][0] == t:
            merged[-1] = (t, "+".join(sorted([merged[-1][1], what])))
        else:
            merged.append((t, what))
    return merged


def _without_blinks(held: np.ndarray) -> np.ndarray:
    """The contact without changes that last one frame."""
    out = held.copy()
    for frame in range(1, len(out) - 1):
        if out[frame] != out[frame - 1] and out[frame] != held[frame + 1]:
            out[frame] = out[frame - 1]
    return out
