"""Edits of a motion graph written as text: which transitions go or stay."""

from __future__ import annotations

import re
from collections.abc import Sequence
from fnmatch import fnmatchcase
from typing import NamedTuple

_SIDE = re.compile(r"(?P<take>[^:>]+?)(?::(?P<first>\d+)(?:-(?P<last>\d+))?)?")
_EVERY = 2**31 - 1


class _Side(NamedTuple):
    take: str
    first: int
    last: int


class Edit:
    """A pattern SOURCE>TARGET; each side is a take (wildcards * and ?), if wanted with :FRAME or :FIRST-LAST.

    `walk>jog` is every transition from walk to jog, `walk:30-50>*` every one that leaves walk within these
    frames.
    """

    def __init__(self, text: str, takes: Sequence[str], who: str) -> None:
        sides = text.replace(" ", "").split(">")
        if len(sides) != 2:
            raise ValueError(f"{who}: an edit must read SOURCE>TARGET, got {text!r}")
        self.source, self.target = (_read_side(side, text, takes, who) for side in sides)

    def covers(self, source: str, m: int, target: str, n: int) -> bool:
        """Whether the transition from frame m of `source` to frame n of `target` is meant."""
        return _within(self.source, source, m) and _within(self.target, target, n)


def _within(side: _Side, take: str, frame: int) -> bool:
    return fnmatchcase(take, side.take) and side.first <= frame <= side.last


def _read_side(side: str, text: str, takes: Sequence[str], who: str) -> _Side:
    match = _SIDE.fullmatch(side)
    if not match:
        raise ValueError(
            f"{who}: each side of an edit must read TAKE, TAKE:FRAME or TAKE:FIRST-LAST, got {text!r}"
        )
    take, first, last = match.group("take", "first", "last")
    if not any(fnmatchcase(name, take) for name in takes):
        raise ValueError(f"{who}: edit {text!r} names take {take!r}; there are {', '.join(takes)}")
    low = int(first) if first else 0
    return _Side(take, low, int(last) if last else (low if first else _EVERY))
