"""A store: a shelf of segments and manifests, and the index that says what is on it."""

from __future__ import annotations

import contextlib
import os
import socket
import threading
import time
import uuid
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from reperform.storage.errors import UNREADABLE, StoreError
from reperform.storage.index import Index, Manifest, Result
from reperform.storage.shelf import cannot_open, failures, is_remote, open_shelf

if TYPE_CHECKING:
    import numpy as np

    from reperform.storage.segment import SegmentReader

HEARTBEAT = 2.0
LAPSE = 30.0


class Store:
    """Opens (or makes) the store at a URL: a local folder, or anything fsspec opens."""

    def __init__(self, url: str | os.PathLike[str]) -> None:
        self.url = str(url) if is_remote(str(url)) else os.path.abspath(url)
        try:
            self.shelf = open_shelf(self.url)
            self.shelf.prepare()
            self.index = self._open_index()
        except failures() as error:
            raise cannot_open(error, self.url) from error
        self.owner = f"{socket.gethostname()}:{os.getpid()}:{uuid.uuid4().hex[:8]}"
        self._beating: threading.Event | None = None
        self._beat: threading.Thread | None = None

    def _open_index(self) -> Index:
        if self.shelf.folder is not None:
            return Index(self.shelf.folder / "index.sqlite")
        from reperform.storage.remote_index import RemoteIndex

        return RemoteIndex(self.shelf)

    # -- claims -------------------------------------------------------------------------------------------------

    def start_heartbeat(self) -> None:
        """Say every other second, from now until `close`, that this run still works on its claims."""
        if self._beating is not None:
            return
        self._beating = stop = threading.Event()

        def beat() -> None:
            index = self.index.reopen()
            while not stop.wait(HEARTBEAT):
                # a beat that fails is no harm: the next may not, and without any the claims lapse
                with contextlib.suppress(StoreError):
                    index.heartbeat(self.owner)
            index.close()

        self._beat = threading.Thread(target=beat, name="claims", daemon=True)
        self._beat.start()

    def claim(self, keys: Sequence[bytes]) -> tuple[set[bytes], dict[bytes, Result]]:
        """Claim keys: those this run may compute now, and results that others have made meanwhile."""
        lapsed = {
            owner: _is_gone(owner) or time.time() - at > LAPSE
            for owner, at in self.index.claim_owners().items()
            if owner != self.owner
        }
        return self.index.claim(keys, self.owner, lapsed)

    def close(self) -> None:
        """End this run's claims and close the index."""
        if self._beating is not None and self._beat is not None:
            self._beating.set()
            self._beat.join(timeout=10)
            self.index.release(self.owner)
        self.index.close()

    # -- damage -------------------------------------------------------------------------------------------------

    def mend(self, segments: Sequence[str]) -> list[str]:
        """Look at files that changed since they were written; forget results that are damaged, and say which.

        Files are only stat'ed; a segment whose stamp differs is read and checked digest by digest.
        """
        notes = []
        for name, segment in self.index.segments(segments).items():
            stamp = self.shelf.stamp(name)
            if stamp == segment.stamp:
                continue
            broken = self.damaged_rows(name)
            if broken == []:
                self.index.restamp(name, stamp)
                continue
            notes.append(self.forget(name, broken))
        return notes

    def damaged_rows(self, name: str) -> list[int] | None:
        """Rows of a segment whose values no longer have their digests; None where nothing of it can be read."""
        from reperform.storage.segment import SegmentReader
        from reperform.storage.tables import unpack_tables

        rows = self.index.rows_of(name)
        try:
            reader = SegmentReader(self.shelf.segments, name)
        except UNREADABLE:
            return None
        return [
            row
            for row, (_, tables) in sorted(rows.items())
            if not _is_intact(reader, unpack_tables(tables), row)
        ]

    def forget(self, segment: str, rows: Sequence[int] | None) -> str:
        """Drop damaged results from the index; returns what to tell the user."""
        count = self.index.drop(segment, rows)
        return f"damaged result of {segment.partition('/')[0]}: {count} item(s) of segment {segment} will be computed again"

    def check(self, manifest: Manifest) -> list[str]:
        """Notes on damage found (and forgotten) in what a manifest names; empty where its files are as written."""
        notes = self.mend(self.index.segments_of(manifest.key))
        if not notes and not self.shelf.has_manifest(manifest.name):
            self.index.drop_manifests([manifest.key])
            notes.append(f"the manifest of a result of {manifest.node} is gone; it is made again")
        return notes


def _is_intact(reader: SegmentReader, tables: Mapping[str, np.ndarray], row: int) -> bool:
    from reperform.storage.manifest import verify_row

    try:
        return verify_row(reader, tables, row)
    except UNREADABLE:
        return False


def _is_gone(owner: str) -> bool:
    """Whether the owner was a process of this machine that lives no more."""
    host, pid, _ = owner.rsplit(":", 2)
    return host == socket.gethostname() and not Path(f"/proc/{pid}").exists() and _dead(int(pid))


def _dead(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return True
    except PermissionError:
        return False
    return False
