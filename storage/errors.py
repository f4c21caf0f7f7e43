"""What can be wrong with a store."""

from __future__ import annotations

from collections.abc import Sequence

# What zarr, its codecs and JSON raise on files that are gone, cut or changed.
UNREADABLE = (
    FileNotFoundError,
    NotADirectoryError,
    ValueError,
    KeyError,
    IndexError,
    RuntimeError,
    TypeError,
)


class DamagedResult(RuntimeError):
    """Stored data is missing, cut or changed; `rows` of `segment` must be computed again."""

    def __init__(self, segment: str, rows: Sequence[int] | None, reason: str) -> None:
        super().__init__(segment, rows, reason)
        self.segment, self.rows, self.reason = segment, rows, reason

    def __str__(self) -> str:
        where = "all rows" if self.rows is None else f"rows {list(self.rows)}"
        return f"stored result {self.segment} ({where}) is damaged: {self.reason}"


class StoreError(OSError):
    """The store cannot be read or written; the message says which, why and the cure."""
