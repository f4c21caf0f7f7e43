"""The index of a store that many machines share: a log of small objects beside the segments, replayed into a local copy.

Every change that others must know of is an object under `index/`, never changed once written; `refresh` replays those not
seen yet into a SQLite file of this machine. What only this machine cares for (history, files, exports) stays there.

Claims need no locks: a run writes the keys that it wants as an object under `claims/`, then lists that folder, and gives
up every key that another living run also wants. Of two runs at least one sees the other, so no key is ever computed by
both, as long as the object store lists what has been written (S3, GCS and Azure do). Where both give up, they try again
after a random moment.
"""

from __future__ import annotations

import base64
import json
import os
import random
import time
import uuid
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from reperform.storage.digest import digest_bytes
from reperform.storage.index import Index, Manifest, Records, Result, Segment
from reperform.storage.shelf import Shelf

LOG, CLAIMS, ALIVE = "index", "claims", "alive"
_TABLES = ("results", "segments", "manifests", "manifest_segments", "applied")


class RemoteIndex(Index):
    """The index of a shelf that is no local folder."""

    def __init__(self, shelf: Shelf, refresh: bool = True) -> None:
        self._shelf = shelf
        self._fs, self._root = shelf.filesystem
        super().__init__(_replica(shelf.url, self._identity()))
        self._db.execute("CREATE TABLE IF NOT EXISTS applied (name TEXT PRIMARY KEY) WITHOUT ROWID")
        # claim object -> its keys that are not finished, for the runs of this process
        self._held: dict[str, set[bytes]] = {}
        # claim objects of others, and when each owner's sign of life last changed, by this machine's clock
        self._theirs: dict[str, tuple[str, frozenset[bytes]]] = {}
        self._signs: dict[str, tuple[bytes, float]] = {}
        if refresh:
            self.refresh()

    def reopen(self) -> RemoteIndex:
        """Another connection, for another thread."""
        return RemoteIndex(self._shelf, refresh=False)

    def _identity(self) -> str:
        """The name of this store: a store made anew at the same URL gets a new one, and with it a new local copy."""
        path = f"{self._root}/store.json"
        try:
            return str(json.loads(self._fs.cat_file(path))["id"])
        except FileNotFoundError:
            name = uuid.uuid4().hex
            self._put("store.json", {"id": name, "layout": 1})
            return name

    # -- the log ------------------------------------------------------------------------------------------------

    def refresh(self) -> None:
        """Replay what others have logged since."""
        names = self._list(LOG)
        seen = {row[0] for row in self._db.execute("SELECT name FROM applied")}
        new = [name for name in names if name not in seen]
        if not new:
            return
        if any(name.endswith("-snapshot.json") for name in new):
            # it stands for all that was removed; what is still there comes after it
            new = sorted(names, key=lambda name: (not name.endswith("-snapshot.json"), name))
            with self._transaction():
                for table in _TABLES:
                    self._db.execute(f"DELETE FROM {table}")
        found = self._fs.cat([f"{self._root}/{LOG}/{name}" for name in new], on_error="omit")
        by_name = {path.rpartition("/")[2]: data for path, data in found.items()}
        for name in new:
            if name in by_name:
                self._replay(json.loads(by_name[name]))
        self._mark(new)

    def _replay(self, event: Mapping[str, Any]) -> None:
        if event["op"] == "commit":
            super().commit(_decoded(event))
        elif event["op"] == "drop":
            super().drop(event["segment"], event["rows"])
        elif event["op"] == "drop_manifests":
            super().drop_manifests([bytes.fromhex(key) for key in event["keys"]])
        elif event["op"] == "touch":
            super().touch([bytes.fromhex(key) for key in event["keys"]])

    def _log(self, event: Mapping[str, Any], kind: str = "") -> str:
        name = f"{time.time_ns():020d}-{uuid.uuid4().hex[:12]}{kind}.json"
        self._put(f"{LOG}/{name}", event)
        return name

    def _mark(self, names: Sequence[str]) -> None:
        with self._transaction():
            self._db.executemany("INSERT OR IGNORE INTO applied VALUES (?)", [(name,) for name in names])

    def compact(self) -> None:
        """Put one object in the place of all that the log holds so far."""
        self.refresh()
        old = self._list(LOG)
        records = Records(segments=self.all_segments())
        for segment in records.segments:
            for row, (key, tables) in self.rows_of(segment.name).items():
                records.results[key] = Result(segment.name, row, tables)
        records.manifests = [(m, self.segments_of(m.key)) for m, _ in self.all_manifests()]
        self._mark([self._log(_encoded(records), "-snapshot")])
        # oldest first: what undoes a change must not go before it
        for name in old:
            self._remove(f"{LOG}/{name}")

    def commit(self, records: Records) -> None:
        """Add results, segments and manifests, and end the claims of these results."""
        if not (records.segments or records.results or records.manifests):
            return
        name = self._log(_encoded(records))
        super().commit(records)
        self._mark([name])
        for claim, keys in list(self._held.items()):
            keys -= records.results.keys()
            if not keys:
                self._remove(f"{CLAIMS}/{claim}")
                del self._held[claim]

    def drop(self, segment: str, rows: Sequence[int] | None = None) -> int:
        """Forget the results in some rows of a segment (None: all) and every manifest that needs them."""
        name = self._log({"op": "drop", "segment": segment, "rows": None if rows is None else list(rows)})
        dropped = super().drop(segment, rows)
        self._mark([name])
        return dropped

    def drop_manifests(self, keys: Sequence[bytes]) -> None:
        """Forget manifests; their results stay."""
        if keys:
            name = self._log({"op": "drop_manifests", "keys": [key.hex() for key in keys]})
            super().drop_manifests(keys)
            self._mark([name])

    def touch(self, keys: Sequence[bytes]) -> None:
        """Record, to the hour, that manifests were asked for."""
        due = [key for key in keys if self._is_due(key)]
        if due:
            name = self._log({"op": "touch", "keys": [key.hex() for key in due]})
            super().touch(due)
            self._mark([name])

    def _is_due(self, key: bytes) -> bool:
        row = self._db.execute("SELECT used FROM manifests WHERE key=?", (key,)).fetchone()
        return row is not None and row[0] < time.time() - 3600

    # -- claims -------------------------------------------------------------------------------------------------

    def claim(
        self, keys: Sequence[bytes], owner: str, lapsed: Mapping[str, bool]
    ) -> tuple[set[bytes], dict[bytes, Result]]:
        """Claim keys for computation; see `Index.claim`."""
        wanted = set(keys)
        name = f"{uuid.uuid4().hex}.json"
        self._put(f"{CLAIMS}/{name}", {"owner": owner, "keys": [key.hex() for key in keys]})
        taken: set[bytes] = set()
        for name_of_theirs, claimant, theirs in self._others(owner):
            if lapsed.get(claimant, False):
                self._remove(f"{CLAIMS}/{name_of_theirs}")
            else:
                taken |= theirs & wanted
        # after the list of claims: who finished in between has given up the claim, but logged the results before
        self.refresh()
        done = self.results(keys)
        mine = wanted - taken - done.keys()
        if mine != wanted:
            # the smaller claim is there before the larger one goes
            larger, name = name, f"{uuid.uuid4().hex}.json"
            if mine:
                self._put(f"{CLAIMS}/{name}", {"owner": owner, "keys": [key.hex() for key in mine]})
            self._remove(f"{CLAIMS}/{larger}")
        if mine:
            self._held[name] = set(mine)
        if taken:
            time.sleep(random.uniform(0, 0.2))
        return mine, done

    def _others(self, owner: str) -> list[tuple[str, str, frozenset[bytes]]]:
        names = self._list(CLAIMS)
        new = [name for name in names if name not in self._theirs and name not in self._held]
        if new:
            found = self._fs.cat([f"{self._root}/{CLAIMS}/{name}" for name in new], on_error="omit")
            for path, data in found.items():
                claim = json.loads(data)
                keys = frozenset(bytes.fromhex(key) for key in claim["keys"])
                self._theirs[path.rpartition("/")[2]] = (claim["owner"], keys)
        self._theirs = {name: self._theirs[name] for name in names if name in self._theirs}
        return [
            (name, claimant, keys) for name, (claimant, keys) in self._theirs.items() if claimant != owner
        ]

    def claim_owners(self) -> dict[str, float]:
        """Owners of claims, and when (by this machine's clock) each was last seen to live."""
        owners = dict.fromkeys(claimant for _, claimant, _ in self._others(""))
        found: dict[str, float] = {}
        for claimant in owners:
            try:
                sign = bytes(self._fs.cat_file(f"{self._root}/{ALIVE}/{claimant}"))
            except FileNotFoundError:
                sign = b""
            last, seen = self._signs.get(claimant, (None, 0.0))
            if sign != last:
                self._signs[claimant] = (sign, time.time())
                seen = time.time()
            found[claimant] = seen
        return found

    def heartbeat(self, owner: str) -> None:
        """Say that the owner still works on its claims."""
        self._put(f"{ALIVE}/{owner}", {"at": time.time()})

    def release(self, owner: str) -> None:
        """End all claims of an owner."""
        for name in self._held:
            self._remove(f"{CLAIMS}/{name}")
        self._held.clear()
        self._remove(f"{ALIVE}/{owner}")

    # -- objects ------------------------------------------------------------------------------------------------

    def _put(self, name: str, value: Mapping[str, Any]) -> None:
        path = f"{self._root}/{name}"
        self._fs.makedirs(path.rpartition("/")[0], exist_ok=True)
        self._fs.pipe_file(path, json.dumps(value).encode())

    def _list(self, folder: str) -> list[str]:
        try:
            found = self._fs.ls(f"{self._root}/{folder}", detail=False)
        except FileNotFoundError:
            return []
        return sorted(path.rstrip("/").rpartition("/")[2] for path in found if path.endswith(".json"))

    def _remove(self, name: str) -> None:
        try:
            self._fs.rm_file(f"{self._root}/{name}")
        except FileNotFoundError:
            return


def replica_folder() -> Path:
    """Where the local copies of indexes are."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "reperform" / "stores"


def _replica(url: str, identity: str) -> Path:
    folder = replica_folder()
    folder.mkdir(parents=True, exist_ok=True)
    return folder / f"{digest_bytes(url.encode(), identity.encode()).hex()}.sqlite"


def _encoded(records: Records) -> dict[str, Any]:
    return {
        "op": "commit",
        "segments": [list(segment) for segment in records.segments],
        "results": [
            [key.hex(), r.segment, r.row, base64.b64encode(r.tables).decode()]
            for key, r in records.results.items()
        ],
        "manifests": [
            [m.key.hex(), m.name, m.node, m.summary, list(segments)] for m, segments in records.manifests
        ],
    }


def _decoded(event: Mapping[str, Any]) -> Records:
    return Records(
        [Segment(*row) for row in event["segments"]],
        {
            bytes.fromhex(key): Result(segment, row, base64.b64decode(tables))
            for key, segment, row, tables in event["results"]
        },
        [
            (Manifest(bytes.fromhex(key), name, node, summary), segments)
            for key, name, node, summary, segments in event["manifests"]
        ],
    )
