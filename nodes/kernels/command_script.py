"""A timeline of commands as text."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple


class Cue(NamedTuple):
    """From `time` (s) on: this motion, with these values of its parameters."""

    time: float
    motion: str
    values: dict[str, float]


def read_script(lines: Sequence[str], who: str = "script") -> list[Cue]:
    """Cues from lines such as `2.5 walk speed=1.4 turning=-0.3`, in order of time.

    Raises ValueError with the number of the line where it cannot be read, or where time goes back.
    """
    cues: list[Cue] = []
    for number, line in enumerate(lines, 1):
        words = line.split()
        where = f"{who}, line {number}"
        if len(words) < 2:
            raise ValueError(f"{where}: must be SECONDS MOTION [PARAMETER=VALUE ..], got {line!r}")
        time = _number(words[0], f"{where}: the time must be a number of seconds")
        if time < 0 or (cues and time < cues[-1].time):
            raise ValueError(
                f"{where}: times must not go back, got {time:g} s: put the lines in order of time"
            )
        values = {}
        for word in words[2:]:
            name, equals, text = word.partition("=")
            if not equals or not name:
                raise ValueError(f"{where}: must be PARAMETER=VALUE, got {word!r}")
            values[name] = _number(text, f"{where}: {name} must be a number")
        cues.append(Cue(time, words[1], values))
    if not cues:
        raise ValueError(f"{who}: needs at least one line, SECONDS MOTION [PARAMETER=VALUE ..]")
    return cues


def _number(text: str, what: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"{what}, got {text!r}")
    return value
