"""Looking after a store: what is listed, verified, collected and copied."""

import numpy as np
import pytest

from reperform.storage.index import Manifest, Records, Result, Segment
from reperform.storage.manifest import Contents
from reperform.storage.store import Store
from reperform.storage.tables import digest_array, pack_tables
from reperform.storage.upkeep import collect, contents, copy, parse_age, parse_size, verify


@pytest.fixture
def store(tmp_path):
    """An empty local store."""
    opened = Store(tmp_path / "store")
    yield opened
    opened.close()


def put(store: Store, node: str, value: float, used: float | None = None) -> Manifest:
    """One whole product, as a run leaves it."""
    array = np.full((100, 100), value)
    name, size, stamp = store.shelf.write_segment(node, {"values": array})
    table = np.frombuffer(digest_array(array), np.uint8)
    key = digest_array(np.array([value]))
    zero = np.zeros(1, np.int32)
    content = Contents("whole", {"values": ()}, {}, {"values": table}, [name], zero, zero)
    store.shelf.write_manifest(key.hex(), content.to_bytes())
    manifest = Manifest(key, key.hex(), node, content.summary())
    records = Records(
        [Segment(name, node, 1, size, 0.5, stamp)],
        {key: Result(name, 0, pack_tables({"values": table}))},
        [(manifest, [name])],
    )
    store.index.commit(records)
    if used is not None:
        store.index._db.execute("UPDATE manifests SET used=? WHERE key=?", (used, key))
    return manifest


def test_contents_by_node(store):
    for value in range(3):
        put(store, "demo.a", value)
    put(store, "demo.b", 9)
    rows = {row["node"]: row for row in contents(store)}
    assert rows["demo.a"] == {"node": "demo.a", "items": 3, "segments": 3, "bytes": 3 * 80_000}
    assert rows["demo.b"]["items"] == 1


def test_verify_finds_what_stamps_cannot(store):
    put(store, "demo.a", 1.5)
    broken = put(store, "demo.a", 2.5)
    assert verify(store) == []
    segment = store.index.segments_of(broken.key)[0]
    chunk = next(
        path
        for path in (store.shelf.folder / "segments" / segment / "values").iterdir()
        if path.name != "zarr.json"
    )
    data = bytearray(chunk.read_bytes())
    data[-9] ^= 1
    chunk.write_bytes(data)
    assert len(verify(store)) == 1
    assert store.index.manifest(broken.key) is None
    assert verify(store) == []


def test_collection_spares_what_is_used_or_kept(store):
    old = put(store, "demo.a", 1.0, used=1000.0)
    kept = put(store, "demo.a", 2.0, used=1000.0)
    fresh = put(store, "demo.a", 3.0)
    assert collect(store, 3600.0, {kept.key}, None, dry_run=True) == (1, 80_000)
    assert store.index.manifest(old.key) is not None
    assert collect(store, 3600.0, {kept.key}, None, dry_run=False) == (1, 80_000)
    assert store.index.manifest(old.key) is None
    assert store.index.manifest(kept.key) and store.index.manifest(fresh.key)
    assert len(store.shelf.names("segments")) == 2
    assert len(store.shelf.names("manifests")) == 2


def test_collection_down_to_a_size_takes_the_longest_unused_first(store):
    found = [put(store, "demo.a", float(k), used=1000.0 + k) for k in range(4)]
    assert collect(store, 0.0, set(), 170_000, dry_run=False)[0] == 2
    assert [store.index.manifest(m.key) is not None for m in found] == [False, False, True, True]


def test_collection_spares_the_work_of_a_run_that_is_going(store):
    manifest = put(store, "demo.a", 1.0)
    store.index.drop_manifests([manifest.key])
    other = Store(store.url)
    other.claim([b"k" * 16])
    assert collect(store, 0.0, set(), None, dry_run=False)[0] == 0
    other.index.release(other.owner)
    other.close()
    assert collect(store, 0.0, set(), None, dry_run=False)[0] == 1


def test_copy_of_a_copy_is_the_same(store, tmp_path):
    manifests = [put(store, "demo.a", float(k)) for k in range(3)]
    target = Store(tmp_path / "copy")
    assert copy(store, target) == (3, 240_000)
    assert copy(store, target) == (0, 0)
    assert verify(target) == []
    assert all(target.check(manifest) == [] for manifest in manifests)
    target.close()


def test_ages_and_sizes():
    assert parse_age("2 d") == 172_800
    assert parse_age("0.5h") == 1800
    assert parse_size("50 GB") == 50e9
    with pytest.raises(ValueError, match="a number with one of the units"):
        parse_age("soon")
