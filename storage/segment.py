"""Segments: one zarr group holding the output of one product, or of a batch of items, row by row.

A field is stored in one of three ways: `whole` (one array), `rows` (rows of one shape, stacked) or `ragged` (rows of
different shapes, concatenated, with offsets and shapes beside). Text is stored as JSON in UTF-8.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

CHUNK_BYTES = 1 << 20


def write_segment(
    store: Any, path: str, fields: Mapping[str, np.ndarray | Sequence[np.ndarray]], by_item: bool = False
) -> int:
    """Write fields (an array is whole, a sequence of arrays is rows) as the zarr group at `path` of a store.

    store: a local folder, or a zarr store.
    by_item: row k of every field belongs to item k (else the segment is one product, whose rows are its frames).
    Returns the number of bytes before compression. A reader sees nothing of it until the index names it.
    """
    layout: dict[str, dict[str, Any]] = {}
    arrays: dict[str, tuple[np.ndarray, int | None]] = {}
    for name, value in fields.items():
        entry: dict[str, Any] = {}
        if isinstance(value, np.ndarray):
            entry["kind"], arrays[name] = "whole", (_encode(value, entry), None)
        else:
            arrays[name] = _stack([np.asarray(row) for row in value], entry)
        layout[name] = entry
    chunked = {name: (data, _chunks(data, rows)) for name, (data, rows) in arrays.items()}
    attributes = {"fields": layout, "by_item": by_item}
    if isinstance(store, Path):
        from reperform.storage.chunk_folder import write_group

        write_group(store / path, attributes, chunked)
    else:
        from reperform.storage.zarr_group import write_zarr_group

        write_zarr_group(store, path, attributes, chunked)
    return sum(data.nbytes for data, _ in arrays.values())


def _encode(array: np.ndarray, entry: dict[str, Any]) -> np.ndarray:
    if array.dtype.kind in "UT":
        entry["text"] = True
        return np.frombuffer(json.dumps(array.tolist()).encode(), np.uint8)
    return np.asarray(array, order="C")


def _stack(rows: list[np.ndarray], entry: dict[str, Any]) -> tuple[np.ndarray, int | None]:
    encoded = [_encode(row, entry) for row in rows]
    if len({row.shape for row in encoded}) <= 1 and encoded:
        entry["kind"] = "rows"
        return np.stack(encoded), len(encoded)
    entry |= {"kind": "ragged", "shapes": [row.shape for row in encoded]}
    entry["dtype"] = encoded[0].dtype.str if encoded else "<f4"
    return np.concatenate([row.ravel() for row in encoded]) if encoded else np.zeros(0, np.float32), None


def _chunks(data: np.ndarray, rows: int | None) -> tuple[int, ...]:
    """The shape of an array's chunks: whole rows, about a megabyte, as many in each as can be."""
    if not data.ndim:
        return ()
    if not rows and data.nbytes <= CHUNK_BYTES:
        return tuple(max(1, n) for n in data.shape)
    most = max(1, CHUNK_BYTES * data.shape[0] // max(1, data.nbytes))
    step = max(1, -(-data.shape[0] // max(1, -(-data.shape[0] // most))))
    return (step, *(max(1, n) for n in data.shape[1:]))


class SegmentReader:
    """Reads fields of one segment; arrays are opened once, chunks on demand."""

    def __init__(self, store: Any, path: str) -> None:
        self._group = _open_group(store, path)
        self._layout: dict[str, Any] = self._group.attrs["fields"]
        self.by_item = bool(self._group.attrs["by_item"])
        self._arrays: dict[str, Any] = {}

    def _array(self, field: str) -> Any:
        if field not in self._arrays:
            self._arrays[field] = self._group[field]
        return self._arrays[field]

    def kind(self, field: str) -> str:
        """`whole`, `rows` or `ragged`."""
        return str(self._layout[field]["kind"])

    def row_shape(self, field: str, row: int) -> tuple[int, ...]:
        """Shape of one row, without reading it (text: unknown until read, so ValueError)."""
        entry = self._layout[field]
        if entry.get("text"):
            raise ValueError(f"the shape of text field {field!r} is known only once read")
        return (
            tuple(entry["shapes"][row]) if entry["kind"] == "ragged" else tuple(self._array(field).shape[1:])
        )

    def whole_shape(self, field: str) -> tuple[int, ...]:
        """Shape of a field stored whole or in rows of one shape."""
        return tuple(self._array(field).shape)

    def dtype(self, field: str) -> np.dtype:
        """dtype of a field as a node sees it."""
        return np.dtype(str) if self._layout[field].get("text") else np.dtype(self._array(field).dtype)

    def whole(self, field: str) -> np.ndarray:
        """A field stored whole."""
        entry = self._layout[field]
        return _decode(self._array(field)[...], entry)

    def rows(self, field: str, rows: Sequence[int]) -> list[np.ndarray]:
        """Some rows of a field stored by rows."""
        entry, array = self._layout[field], self._array(field)
        if entry["kind"] == "ragged":
            sizes = [int(np.prod(shape, dtype=int)) for shape in entry["shapes"]]
            ends = np.cumsum(sizes)
            return [
                _decode(array[int(ends[k]) - sizes[k] : int(ends[k])].reshape(entry["shapes"][k]), entry)
                for k in rows
            ]
        out: list[np.ndarray] = []
        for start, stop in _runs(rows):
            block = array[start:stop]
            out += [_decode(row, entry) for row in block]
        return out


def _open_group(store: Any, path: str) -> Any:
    if isinstance(store, Path):
        from reperform.storage.chunk_folder import ChunkFolder

        return ChunkFolder(store / path)
    from reperform.storage.zarr_group import open_zarr_group

    return open_zarr_group(store, path)


def _decode(data: Any, entry: Mapping[str, Any]) -> np.ndarray:
    data = np.asarray(data)
    return np.array(json.loads(data.tobytes()), dtype=str) if entry.get("text") else data


def _runs(rows: Sequence[int]) -> list[tuple[int, int]]:
    """Consecutive rows as (start, stop) spans."""
    spans: list[tuple[int, int]] = []
    for row in rows:
        if spans and spans[-1][1] == row:
            spans[-1] = (spans[-1][0], row + 1)
        else:
            spans.append((row, row + 1))
    return spans
