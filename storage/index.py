"""The index: which key has which result, and where. A run with nothing to do reads this and no array.

Only the coordinating process of a run writes here, in batches, one transaction each.
"""

from __future__ import annotations

import errno
import json
import sqlite3
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from reperform.storage.errors import StoreError

SCHEMA = """
CREATE TABLE IF NOT EXISTS results (
    key BLOB PRIMARY KEY, segment TEXT NOT NULL, row INTEGER NOT NULL, tables BLOB NOT NULL) WITHOUT ROWID;
CREATE INDEX IF NOT EXISTS results_by_segment ON results (segment);
CREATE TABLE IF NOT EXISTS segments (
    name TEXT PRIMARY KEY, node TEXT NOT NULL, rows INTEGER NOT NULL, bytes INTEGER NOT NULL,
    seconds REAL NOT NULL, stamp TEXT NOT NULL, created REAL NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS manifests (
    key BLOB PRIMARY KEY, name TEXT NOT NULL, node TEXT NOT NULL, summary TEXT NOT NULL, created REAL NOT NULL,
    used REAL NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS manifest_segments (
    manifest BLOB NOT NULL, segment TEXT NOT NULL, PRIMARY KEY (segment, manifest)) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS claims (key BLOB PRIMARY KEY, owner TEXT NOT NULL, at REAL NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS history (
    pipeline TEXT, step TEXT, unit TEXT, parts TEXT NOT NULL, at REAL NOT NULL,
    PRIMARY KEY (pipeline, step, unit)) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS files (
    path TEXT PRIMARY KEY, size INTEGER NOT NULL, changed INTEGER NOT NULL, digest BLOB NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS exports (path TEXT PRIMARY KEY, digest BLOB NOT NULL, stamp TEXT NOT NULL) WITHOUT ROWID;
"""
_MANY = 900  # keys in one SELECT ... IN (...)


class Result(NamedTuple):
    """Where one item's output lies, and the digests of its fields (packed)."""

    segment: str
    row: int
    tables: bytes


class Segment(NamedTuple):
    """One zarr group: what wrote it, its size, and a stamp of its files as they were written."""

    name: str
    node: str
    rows: int
    bytes: int
    seconds: float
    stamp: str


class Manifest(NamedTuple):
    """The complete output of a step for one take: the object that lists its items, and a summary of digests."""

    key: bytes
    name: str
    node: str
    summary: dict[str, Any]


@dataclass
class Records:
    """What one transaction adds."""

    segments: list[Segment] = field(default_factory=list)
    results: dict[bytes, Result] = field(default_factory=dict)
    manifests: list[tuple[Manifest, Sequence[str]]] = field(default_factory=list)


class _Connection(sqlite3.Connection):
    """A connection whose errors are told as errors of the store, with their cure."""

    def execute(self, *arguments: Any) -> sqlite3.Cursor:
        try:
            return super().execute(*arguments)
        except sqlite3.DatabaseError as error:
            raise _explained(error) from error

    def executemany(self, *arguments: Any) -> sqlite3.Cursor:
        try:
            return super().executemany(*arguments)
        except sqlite3.DatabaseError as error:
            raise _explained(error) from error


def _explained(error: sqlite3.DatabaseError) -> StoreError:
    cures = {
        sqlite3.SQLITE_FULL: "the disk is full: free space or run `reperform store gc`, then run again; finished items are kept",
        sqlite3.SQLITE_IOERR: "the disk failed or is full: mend the cause, then run again; finished items are kept",
        sqlite3.SQLITE_READONLY: "no permission to write there: choose another place with --store",
        sqlite3.SQLITE_BUSY: "another run holds it for more than a minute: look for one that hangs",
        sqlite3.SQLITE_CORRUPT: "it is damaged: delete index.sqlite in the store; results are then computed again",
        sqlite3.SQLITE_NOTADB: "it is no index: delete index.sqlite in the store; results are then computed again",
    }
    code = getattr(error, "sqlite_errorcode", 0) & 0xFF
    cure = cures.get(code, "check the folder of the store and its permissions")
    return StoreError(errno.EIO, f"the index of the store cannot be used ({error}): {cure}")


class Index:
    """The index in one SQLite file."""

    def __init__(self, path: Path | str) -> None:
        self._path = path
        self._db = sqlite3.connect(
            path, timeout=60, isolation_level=None, check_same_thread=False, factory=_Connection
        )
        for attempt in range(100):
            try:
                self._db.execute("PRAGMA journal_mode=WAL")
                break
            except StoreError as error:
                # SQLite does not wait here while another run, as new as this one, makes the same change
                code = getattr(error.__cause__, "sqlite_errorcode", 0) & 0xFF
                if attempt == 99 or code not in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
                    raise
                time.sleep(0.05)
        self._db.execute("PRAGMA synchronous=NORMAL")
        if not self._db.execute("SELECT 1 FROM sqlite_master WHERE name='exports'").fetchone():
            with self._transaction():
                for statement in SCHEMA.split(";")[:-1]:
                    self._db.execute(statement)

    def reopen(self) -> Index:
        """Another connection, for another thread."""
        return Index(self._path)

    def compact(self) -> None:
        """Give space back that deleted rows took."""
        self._db.execute("VACUUM")

    def close(self) -> None:
        """Close the file."""
        self._db.close()

    # -- looking up ---------------------------------------------------------------------------------------------

    def manifest(self, key: bytes) -> Manifest | None:
        """The complete output under a key, if all of it is there."""
        row = self._db.execute(
            "SELECT key, name, node, summary FROM manifests WHERE key=?", (key,)
        ).fetchone()
        return Manifest(row[0], row[1], row[2], json.loads(row[3])) if row else None

    def results(self, keys: Sequence[bytes]) -> dict[bytes, Result]:
        """The results that exist among the keys."""
        found: dict[bytes, Result] = {}
        for start in range(0, len(keys), _MANY):
            some = keys[start : start + _MANY]
            marks = ",".join("?" * len(some))
            sql = f"SELECT key, segment, row, tables FROM results WHERE key IN ({marks})"
            found |= {row[0]: Result(*row[1:]) for row in self._db.execute(sql, some)}
        return found

    def segments(self, names: Iterable[str]) -> dict[str, Segment]:
        """Segments by name."""
        found: dict[str, Segment] = {}
        names = list(names)
        for start in range(0, len(names), _MANY):
            some = names[start : start + _MANY]
            sql = f"SELECT name, node, rows, bytes, seconds, stamp FROM segments WHERE name IN ({','.join('?' * len(some))})"
            found |= {row[0]: Segment(*row) for row in self._db.execute(sql, some)}
        return found

    def segments_of(self, manifest: bytes) -> list[str]:
        """Names of the segments that a manifest's items lie in."""
        return [
            r[0]
            for r in self._db.execute("SELECT segment FROM manifest_segments WHERE manifest=?", (manifest,))
        ]

    def seconds_per_item(self, node: str) -> float | None:
        """Mean time of one item of a node, as measured so far."""
        total, rows = self._db.execute(
            "SELECT SUM(seconds), SUM(rows) FROM segments WHERE node=?", (node,)
        ).fetchone()
        return total / rows if rows else None

    def bytes_per_item(self, node: str) -> float | None:
        """Mean size of one item of a node before compression, as measured so far."""
        total, rows = self._db.execute(
            "SELECT SUM(bytes), SUM(rows) FROM segments WHERE node=?", (node,)
        ).fetchone()
        return total / rows if rows else None

    def all_segments(self) -> list[Segment]:
        """Every segment."""
        return [
            Segment(*r)
            for r in self._db.execute("SELECT name, node, rows, bytes, seconds, stamp FROM segments")
        ]

    def all_manifests(self) -> list[tuple[Manifest, float]]:
        """Every manifest with the time it was last asked for."""
        sql = "SELECT key, name, node, summary, used FROM manifests"
        return [(Manifest(r[0], r[1], r[2], json.loads(r[3])), r[4]) for r in self._db.execute(sql)]

    def created(self, segment: str) -> float:
        """When a segment was written."""
        row = self._db.execute("SELECT created FROM segments WHERE name=?", (segment,)).fetchone()
        return float(row[0]) if row else 0.0

    def rows_of(self, segment: str) -> dict[int, tuple[bytes, bytes]]:
        """row -> (key, packed digests) of the results that lie in a segment."""
        sql = "SELECT row, key, tables FROM results WHERE segment=?"
        return {row: (key, tables) for row, key, tables in self._db.execute(sql, (segment,))}

    # -- writing ------------------------------------------------------------------------------------------------

    def commit(self, records: Records) -> None:
        """Add results, segments and manifests, and end the claims of these results, in one transaction."""
        now = time.time()
        with self._transaction():
            self._db.executemany(
                "INSERT OR REPLACE INTO segments VALUES (?,?,?,?,?,?,?)",
                [(*s, now) for s in records.segments],
            )
            self._db.executemany(
                "INSERT OR REPLACE INTO results VALUES (?,?,?,?)",
                [(k, *r) for k, r in records.results.items()],
            )
            self._db.executemany("DELETE FROM claims WHERE key=?", [(k,) for k in records.results])
            for manifest, segments in records.manifests:
                self._db.execute(
                    "INSERT OR REPLACE INTO manifests VALUES (?,?,?,?,?,?)",
                    (manifest.key, manifest.name, manifest.node, json.dumps(manifest.summary), now, now),
                )
                self._db.executemany(
                    "INSERT OR IGNORE INTO manifest_segments VALUES (?,?)",
                    [(manifest.key, s) for s in segments],
                )

    def drop(self, segment: str, rows: Sequence[int] | None = None) -> int:
        """Forget the results in some rows of a segment (None: all) and every manifest that needs them."""
        with self._transaction():
            if rows is None:
                dropped = self._db.execute("DELETE FROM results WHERE segment=?", (segment,)).rowcount
                self._db.execute("DELETE FROM segments WHERE name=?", (segment,))
            else:
                marks = ",".join("?" * len(rows))
                sql = f"DELETE FROM results WHERE segment=? AND row IN ({marks})"
                dropped = self._db.execute(sql, (segment, *rows)).rowcount
            self._db.execute(
                "DELETE FROM manifests WHERE key IN (SELECT manifest FROM manifest_segments WHERE segment=?)",
                (segment,),
            )
            self._db.execute("DELETE FROM manifest_segments WHERE segment=?", (segment,))
        return dropped

    def drop_manifests(self, keys: Sequence[bytes]) -> None:
        """Forget manifests; their results stay."""
        with self._transaction():
            self._db.executemany("DELETE FROM manifests WHERE key=?", [(k,) for k in keys])
            self._db.executemany("DELETE FROM manifest_segments WHERE manifest=?", [(k,) for k in keys])

    def restamp(self, segment: str, stamp: str) -> None:
        """Record that a segment's files, as they are now, have been verified."""
        self._db.execute("UPDATE segments SET stamp=? WHERE name=?", (stamp, segment))

    def touch(self, keys: Sequence[bytes]) -> None:
        """Record, to the hour, that manifests were asked for (collection spares what was used lately)."""
        now = time.time()
        with self._transaction():
            sql = "UPDATE manifests SET used=? WHERE key=? AND used<?"
            self._db.executemany(sql, [(now, key, now - 3600) for key in keys])

    # -- claims -------------------------------------------------------------------------------------------------

    def claim(
        self, keys: Sequence[bytes], owner: str, lapsed: Mapping[str, bool]
    ) -> tuple[set[bytes], dict[bytes, Result]]:
        """Claim keys for computation. Returns those that are now the owner's, and results that exist by now.

        A key claimed by another owner is in neither; the claim of an owner for whom `lapsed` says True is taken over.
        """
        now = time.time()
        with self._transaction():
            done = self.results(keys)
            open_keys = [key for key in keys if key not in done]
            held: dict[bytes, str] = {}
            for start in range(0, len(open_keys), _MANY):
                some = open_keys[start : start + _MANY]
                sql = f"SELECT key, owner FROM claims WHERE key IN ({','.join('?' * len(some))})"
                held |= dict(self._db.execute(sql, some).fetchall())
            mine = {k for k in open_keys if k not in held or held[k] == owner or lapsed.get(held[k], False)}
            self._db.executemany(
                "INSERT OR REPLACE INTO claims VALUES (?,?,?)", [(k, owner, now) for k in mine]
            )
        return mine, done

    def claim_owners(self) -> dict[str, float]:
        """Owners of claims and when each was last heard of."""
        return dict(self._db.execute("SELECT owner, MAX(at) FROM claims GROUP BY owner").fetchall())

    def heartbeat(self, owner: str) -> None:
        """Say that the owner still works on its claims."""
        self._db.execute("UPDATE claims SET at=? WHERE owner=?", (time.time(), owner))

    def release(self, owner: str) -> None:
        """End all claims of an owner."""
        self._db.execute("DELETE FROM claims WHERE owner=?", (owner,))

    # -- what happened, for `why` and for files -----------------------------------------------------------------

    def history(self, pipeline: str, step: str, unit: str) -> dict[str, Any] | None:
        """The parts of the key that a unit had when it last completed."""
        sql = "SELECT parts FROM history WHERE pipeline=? AND step=? AND unit=?"
        row = self._db.execute(sql, (pipeline, step, unit)).fetchone()
        return json.loads(row[0]) if row else None

    def remembered_keys(self, pipeline: str) -> dict[tuple[str, str], str]:
        """The last completed key of every unit of a pipeline by (step, unit)."""
        sql = "SELECT step, unit, json_extract(parts, '$.key') FROM history WHERE pipeline=?"
        return {(step, unit): key for step, unit, key in self._db.execute(sql, (pipeline,))}

    def remember(self, pipeline: str, rows: Mapping[tuple[str, str], Mapping[str, Any]]) -> None:
        """Store the parts of the keys of (step, unit)."""
        now = time.time()
        with self._transaction():
            self._db.executemany(
                "INSERT OR REPLACE INTO history VALUES (?,?,?,?,?)",
                [(pipeline, step, unit, json.dumps(parts), now) for (step, unit), parts in rows.items()],
            )

    def file_digest(self, path: str, size: int, changed: int) -> bytes | None:
        """The digest of a file seen before with this size and change time (a shortcut; neither is in any key)."""
        sql = "SELECT digest FROM files WHERE path=? AND size=? AND changed=?"
        row = self._db.execute(sql, (path, size, changed)).fetchone()
        return row[0] if row else None

    def remember_files(self, rows: Sequence[tuple[str, int, int, bytes]]) -> None:
        """Store digests of files by path, size and change time."""
        with self._transaction():
            self._db.executemany("INSERT OR REPLACE INTO files VALUES (?,?,?,?)", rows)

    def export(self, path: str) -> tuple[bytes, str] | None:
        """Digest and stamp with which a file was last exported."""
        row = self._db.execute("SELECT digest, stamp FROM exports WHERE path=?", (path,)).fetchone()
        return (row[0], row[1]) if row else None

    def remember_export(self, path: str, digest: bytes, stamp: str) -> None:
        """Store digest and stamp of an exported file."""
        self._db.execute("INSERT OR REPLACE INTO exports VALUES (?,?,?)", (path, digest, stamp))

    def _transaction(self) -> _Transaction:
        return _Transaction(self._db)


class _Transaction:
    """BEGIN IMMEDIATE .. COMMIT, or ROLLBACK on any error."""

    def __init__(self, db: sqlite3.Connection) -> None:
        self._db = db

    def __enter__(self) -> None:
        self._db.execute("BEGIN IMMEDIATE")

    def __exit__(self, kind: object, *_: object) -> None:
        if kind is None:
            self._db.execute("COMMIT")
        elif self._db.in_transaction:
            self._db.execute("ROLLBACK")
