"""How many items make a batch: by the pace of a node, measured so far. It changes no key and no result."""

from __future__ import annotations

import os

from reperform.storage.index import Index

BATCH_SECONDS = 0.5
BATCH_ITEMS = 512
BATCH_BYTES = 64 << 20


class Pace:
    """Seconds and bytes per item of every node, from this run, else from earlier ones."""

    def __init__(self, index: Index) -> None:
        self._index = index
        self._known: dict[str, tuple[float | None, float | None]] = {}

    def measured(self, node: str, items: int, seconds: float, size: int) -> None:
        """So many items took this long and this many bytes."""
        self._known[node] = (seconds / max(items, 1), size / max(items, 1))

    def batch_size(self, node: str, waiting: int, slots: int) -> int:
        """How many items make about half a second of work; a few until the pace is known."""
        if node not in self._known:
            self._known[node] = (self._index.seconds_per_item(node), self._index.bytes_per_item(node))
        seconds, size = self._known[node]
        if seconds is None or size is None:
            return max(1, min(8, waiting // (4 * slots)))
        fair = -(-waiting // slots)
        return max(
            1, int(min(BATCH_SECONDS / max(seconds, 1e-6), BATCH_BYTES / max(size, 1), BATCH_ITEMS, fair))
        )


def memory() -> float:
    """GB of memory that batches in flight may declare together."""
    return 0.8 * os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 1e9
