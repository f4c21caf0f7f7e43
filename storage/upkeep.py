"""Looking after a store: what is in it, whether it is sound, what may go, and copies of it."""

from __future__ import annotations

import re
import time
from collections.abc import Collection
from typing import Any

from reperform.storage.index import Records, Result
from reperform.storage.shelf import MANIFESTS, SEGMENTS
from reperform.storage.store import Store

_AGES = {"s": 1.0, "min": 60.0, "h": 3600.0, "d": 86400.0, "w": 604800.0}
_SIZES = {"B": 1.0, "kB": 1e3, "MB": 1e6, "GB": 1e9, "TB": 1e12}
# an unfinished segment younger than this may still be written by a run
UNFINISHED = 3600.0


def contents(store: Store) -> list[dict[str, Any]]:
    """Items, segments and bytes (before compression) by node."""
    rows: dict[str, dict[str, Any]] = {}
    for segment in store.index.all_segments():
        row = rows.setdefault(segment.node, {"node": segment.node, "items": 0, "segments": 0, "bytes": 0})
        row["items"] += segment.rows
        row["segments"] += 1
        row["bytes"] += segment.bytes
    return [rows[node] for node in sorted(rows)]


def verify(store: Store) -> list[str]:
    """Read every result and check its digests; forget what is damaged. Returns a note per damaged segment."""
    notes = []
    for segment in store.index.all_segments():
        broken = store.damaged_rows(segment.name)
        if broken != []:
            notes.append(store.forget(segment.name, broken))
    return notes


def collect(
    store: Store, age: float, spared: Collection[bytes], limit: float | None, dry_run: bool
) -> tuple[int, int]:
    """Delete results last used more than `age` seconds ago that no spared manifest needs.

    limit: collect, least recently used first, only until the store holds no more bytes than this.
    Returns the number of segments and their bytes.
    """
    now = time.time()
    manifests = sorted(store.index.all_manifests(), key=lambda entry: entry[1])
    segments = {segment.name: segment for segment in store.index.all_segments()}
    total = sum(segment.bytes for segment in segments.values())
    users: dict[str, set[bytes]] = {name: set() for name in segments}
    for manifest, _ in manifests:
        for name in store.index.segments_of(manifest.key):
            users.setdefault(name, set()).add(manifest.key)
    unused = [name for name, keys in users.items() if not keys and _is_old(store, name, now, age)]
    gone, freed = list(unused), sum(segments[name].bytes for name in unused if name in segments)
    dropped = []
    for manifest, used in manifests:
        if manifest.key in spared or now - used < age or (limit is not None and total - freed <= limit):
            continue
        dropped.append(manifest)
        for name in store.index.segments_of(manifest.key):
            users[name].discard(manifest.key)
            if not users[name] and name in segments:
                gone.append(name)
                freed += segments[name].bytes
    if not dry_run:
        store.index.drop_manifests([manifest.key for manifest in dropped])
        for name in gone:
            store.index.drop(name)
            store.shelf.remove(SEGMENTS, name)
        for manifest in dropped:
            store.shelf.remove(MANIFESTS, manifest.name)
        _sweep(store, now)
        store.index.compact()
    return len(gone), freed


def _is_old(store: Store, name: str, now: float, age: float) -> bool:
    # results of a run that is still going have no manifest yet
    return now - store.index.created(name) > max(age, 0.0) and not store.index.claim_owners()


def _sweep(store: Store, now: float) -> None:
    """Remove files that no index row names: what killed runs left behind."""
    known = {segment.name for segment in store.index.all_segments()}
    for name in store.shelf.names(SEGMENTS):
        if name not in known and now - store.shelf.changed(SEGMENTS, name) > UNFINISHED:
            store.shelf.remove(SEGMENTS, name)
    named = {manifest.name for manifest, _ in store.index.all_manifests()}
    for name in store.shelf.names(MANIFESTS):
        if name not in named and now - store.shelf.changed(MANIFESTS, name) > UNFINISHED:
            store.shelf.remove(MANIFESTS, name)


def copy(source: Store, target: Store) -> tuple[int, int]:
    """Copy all segments and manifests that the target does not have. Returns segments and bytes copied."""
    there = {segment.name for segment in target.index.all_segments()}
    count = size = 0
    for segment in source.index.all_segments():
        if segment.name in there:
            continue
        source.shelf.copy_to(target.shelf, SEGMENTS, segment.name)
        rows = source.index.rows_of(segment.name)
        stamped = segment._replace(stamp=target.shelf.stamp(segment.name))
        results = {key: Result(segment.name, row, tables) for row, (key, tables) in rows.items()}
        target.index.commit(Records([stamped], results))
        count, size = count + 1, size + segment.bytes
    for manifest, _ in source.index.all_manifests():
        if target.index.manifest(manifest.key) is None:
            source.shelf.copy_to(target.shelf, MANIFESTS, manifest.name)
            target.index.commit(Records(manifests=[(manifest, source.index.segments_of(manifest.key))]))
    return count, size


def parse_age(text: str) -> float:
    """Seconds of `7 d`, `12 h`, `30 min`, `10 s`, `2 w`. Raises ValueError with what is understood."""
    return _quantity(text, _AGES, "an age")


def parse_size(text: str) -> float:
    """Bytes of `50 GB`, `200 MB`. Raises ValueError with what is understood."""
    return _quantity(text, _SIZES, "a size")


def _quantity(text: str, units: dict[str, float], what: str) -> float:
    match = re.fullmatch(r"\s*([0-9.]+)\s*([A-Za-z]+)\s*", text)
    if not match or match[2] not in units:
        raise ValueError(f"{what} is a number with one of the units {', '.join(units)}, got {text!r}")
    return float(match[1]) * units[match[2]]
