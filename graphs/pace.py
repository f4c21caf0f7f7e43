"""How many items make a batch, and how many batches run at a time. It changes no key and no result."""

from __future__ import annotations

import os

from reperform.nodes.catalogue import NodeSpec
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


class Room:
    """Threads and memory that the batches in flight have declared. One batch always fits, however large."""

    def __init__(self) -> None:
        self.slots = 1
        self._memory = 0.8 * os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 1e9
        self._batches, self._threads, self._used = 0, 0, 0.0

    @property
    def is_full(self) -> bool:
        """Whether not even a batch of one thread fits."""
        return self._threads >= self.slots

    def fits(self, node: NodeSpec) -> bool:
        """Whether there is room for a batch of a node."""
        fits = self._threads + node.threads <= self.slots and self._used + node.memory <= self._memory
        return fits or self._batches == 0

    def take(self, node: NodeSpec) -> None:
        """A batch of a node starts."""
        self._batches, self._threads, self._used = (
            self._batches + 1,
            self._threads + node.threads,
            self._used + node.memory,
        )

    def give(self, node: NodeSpec) -> None:
        """It is over."""
        self._batches, self._threads, self._used = (
            self._batches - 1,
            self._threads - node.threads,
            self._used - node.memory,
        )
