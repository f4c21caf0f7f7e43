"""What is written straight is zarr, and what zarr writes is read straight; damage is an error."""

import numpy as np
import pytest
import zarr
from zarr.storage import LocalStore

from reperform.storage.chunk_folder import ChunkFolder, write_group
from reperform.storage.errors import UNREADABLE
from reperform.storage.segment import SegmentReader, write_segment
from reperform.storage.zarr_group import write_zarr_group

RANDOM = np.random.default_rng(4)
ARRAYS = {
    "rows": (RANDOM.standard_normal((7, 3, 5)).astype(np.float32), (3, 3, 5)),
    "bytes": (RANDOM.integers(0, 256, (4, 11), np.uint8), (4, 11)),
    "whole": (np.float64(2.5) * np.ones(()), ()),
    "flags": (RANDOM.random(9) < 0.5, (2,)),
    "swapped": (np.arange(6, dtype=">i4").reshape(2, 3), (1, 3)),
    "complex": (np.array([1 + 2j, -3j]), (2,)),
    "empty": (np.zeros((0, 4), np.int16), (1, 4)),
    "inner": (np.ones(3, np.uint16), (3,)),
}


def _same(stored, expected):
    assert stored.shape == expected.shape
    assert np.dtype(stored.dtype) == expected.dtype.newbyteorder("<")
    np.testing.assert_array_equal(np.asarray(stored[...]), expected)


def test_zarr_reads_what_is_written_straight(tmp_path):
    write_group(tmp_path / "node" / "s", {"fields": {"a": [1]}}, ARRAYS)
    group = zarr.open_group(LocalStore(tmp_path), path="node/s", mode="r")
    assert group.attrs["fields"] == {"a": [1]}
    for name, (array, _) in ARRAYS.items():
        _same(group[name], array)


def test_what_zarr_writes_is_read_straight(tmp_path):
    write_zarr_group(LocalStore(tmp_path), "node/s", {"by_item": True}, ARRAYS)
    group = ChunkFolder(tmp_path / "node" / "s")
    assert group.attrs["by_item"] is True
    for name, (array, _) in ARRAYS.items():
        _same(group[name], array)


@pytest.mark.parametrize(("first", "last"), [(0, 7), (0, 1), (2, 4), (3, 6), (5, 7), (6, 9), (4, 4)])
def test_any_run_of_rows(tmp_path, first, last):
    write_group(tmp_path / "s", {}, ARRAYS)
    np.testing.assert_array_equal(
        ChunkFolder(tmp_path / "s")["rows"][first:last], ARRAYS["rows"][0][first:last]
    )


def test_both_write_the_same_bytes(tmp_path):
    arrays = {name: (a.astype(a.dtype.newbyteorder("<")), c) for name, (a, c) in ARRAYS.items()}
    write_group(tmp_path / "one", {}, arrays)
    write_zarr_group(LocalStore(tmp_path), "two", {}, arrays)
    chunks = sorted(p.relative_to(tmp_path / "one") for p in (tmp_path / "one").rglob("c*") if p.is_file())
    assert chunks == sorted(
        p.relative_to(tmp_path / "two") for p in (tmp_path / "two").rglob("c*") if p.is_file()
    )
    for chunk in chunks:
        assert (tmp_path / "one" / chunk).read_bytes() == (tmp_path / "two" / chunk).read_bytes()


def test_a_dtype_that_zarr_has_no_name_for_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"must be of one of .*float32"):
        write_group(tmp_path / "s", {}, {"text": (np.array(["a", "bc"]), (2,))})


def test_an_existing_segment_is_never_written_over(tmp_path):
    write_group(tmp_path / "s", {}, {})
    with pytest.raises(FileExistsError):
        write_group(tmp_path / "s", {}, ARRAYS)


@pytest.mark.parametrize("damage", ["gone", "cut", "emptied", "garbled", "undescribed"])
def test_damage_is_told(tmp_path, damage):
    write_group(tmp_path / "s", {}, ARRAYS)
    chunk = tmp_path / "s" / "rows" / "c.1.0.0"
    whole = chunk.read_bytes()
    if damage == "gone":
        chunk.unlink()
    elif damage == "undescribed":
        (tmp_path / "s" / "rows" / "zarr.json").write_bytes(b"{}")
    else:
        chunk.write_bytes({"cut": whole[:-9], "emptied": b"", "garbled": b"\0" * len(whole)}[damage])
    with pytest.raises(UNREADABLE):
        ChunkFolder(tmp_path / "s")["rows"][...]


def test_segments_give_back_rows_of_any_shape(tmp_path):
    ragged = [RANDOM.random((n, 2)).astype(np.float32) for n in (3, 0, 5)]
    names = [np.array(["left", "o"]), np.array(["right hand"])]
    large = list(RANDOM.integers(0, 9, (5, 200_000)).astype(np.int32))
    size = write_segment(tmp_path, "s", {"ragged": ragged, "names": names, "large": large}, by_item=True)
    assert size >= sum(a.nbytes for a in ragged) + sum(a.nbytes for a in large)
    reader = SegmentReader(tmp_path, "s")
    assert reader.by_item and reader.kind("large") == "rows" and reader.kind("ragged") == "ragged"
    for field, rows in (("ragged", ragged), ("names", names), ("large", large)):
        order = [*range(len(rows))][::-1]
        for row, got in zip(order, reader.rows(field, order), strict=True):
            np.testing.assert_array_equal(got, rows[row])
