"""Errors in definitions and in runs."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Place:
    """A line of a pipeline file (line 0: what was given on the command line)."""

    file: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}" if self.line else self.file


class DefinitionError(ValueError):
    """A pipeline, or a call, that cannot be run as written: where, what was expected, the nearest right name."""

    def __init__(self, message: str, place: Place | None = None) -> None:
        super().__init__(f"{place}: {message}" if place else message)


class RunError(RuntimeError):
    """Steps failed; the message says which item, why, and the command that reruns only it."""

    def __init__(self, message: str, report: Any) -> None:
        super().__init__(message)
        self.report = report


def nearest(name: str, known: Iterable[str], limit: int = 12) -> str:
    """What to say about a wrong name: the nearest right one, or those that exist."""
    known = list(known)
    close = difflib.get_close_matches(name, known, 1, 0.5)
    if close:
        return f"did you mean {close[0]!r}?"
    if not known:
        return "there is none"
    more = ", ..." if len(known) > limit else ""
    return f"known are: {', '.join(map(repr, known[:limit]))}{more}"
