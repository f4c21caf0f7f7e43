"""Scripted hands: keys pressed and paths drawn at given times."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from reperform.viewer.play_session import PlaySession

_ACTS = {"press": 1, "release": 1, "draw": 2, "follow": 0}


class Act(NamedTuple):
    """At a time (s) one thing is done: press or release a key, draw a place on the ground, follow what was drawn."""

    time: float
    what: str
    words: tuple[str, ...]


def read_acts(lines: Sequence[str], name: str = "input") -> list[Act]:
    """Acts from lines `SECONDS press KEY`, `.. release KEY`, `.. draw X Z`, `.. follow`; # begins a comment.

    Raises ValueError with the number of the line that cannot be read.
    """
    acts = []
    for number, line in enumerate(lines, 1):
        words = line.partition("#")[0].split()
        if not words:
            continue
        try:
            time, what, rest = float(words[0]), words[1], tuple(words[2:])
            fits = _ACTS[what] == len(rest)
            _ = [float(word) for word in rest] if what == "draw" else None
        except (ValueError, IndexError, KeyError):
            fits = False
        if not fits:
            raise ValueError(
                f"{name}, line {number}: must be SECONDS press KEY, release KEY, draw X Z or follow, got {line!r}"
            )
        acts.append(Act(time, what, rest))
    return sorted(acts, key=lambda act: act.time)


class ScriptedInput:
    """Does to a session what is due; `due(time)`, times in order."""

    def __init__(self, acts: Sequence[Act]) -> None:
        self._left = list(acts)

    def due(self, session: PlaySession, time: float) -> None:
        """Do all that was to be done by now (s)."""
        while self._left and self._left[0].time <= time + 1e-9:
            act = self._left.pop(0)
            if act.what == "draw":
                session.draw(float(act.words[0]), float(act.words[1]))
            elif act.what == "follow":
                session.follow()
            elif act.what == "press":
                session.press(act.words[0])
            else:
                session.release(act.words[0])
