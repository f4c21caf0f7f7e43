"""Who is told how far the work is."""

from __future__ import annotations

from typing import Protocol


class Progress(Protocol):
    """Who is told how far the work is."""

    def start(self, step: str, total: int) -> None:
        """A step has so many items (more)."""

    def advance(self, step: str, computed: int = 1, cached: int = 0, failed: int = 0) -> None:
        """So many of them are over."""

    def finish(self, step: str) -> None:
        """A step is over."""

    def note(self, text: str) -> None:
        """Something that a user should know."""


class Silent:
    """Nobody is told."""

    def start(self, step: str, total: int) -> None:
        """Say nothing."""

    def advance(self, step: str, computed: int = 1, cached: int = 0, failed: int = 0) -> None:
        """Say nothing."""

    def finish(self, step: str) -> None:
        """Say nothing."""

    def note(self, text: str) -> None:
        """Say nothing."""
