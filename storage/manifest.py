"""Manifests: the complete output of a step for one take: which items it has, where they lie, digests of all fields."""

from __future__ import annotations

import functools
import io
import json
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from reperform.storage.digest import digest_bytes
from reperform.storage.errors import UNREADABLE, DamagedResult
from reperform.storage.shelf import open_shelf
from reperform.storage.tables import digest_table

if TYPE_CHECKING:
    from reperform.storage.segment import SegmentReader

Layout = Literal["whole", "frame", "view"]


@dataclass(frozen=True)
class Contents:
    """What a manifest says.

    layout: what one item is: the whole product, one frame, or one view (items in frame-major order).
    axes: item axes (`frame`, `camera`) of every field.  lengths: their lengths.
    tables: digests of every field along its item axes, uint8 (*lengths, 16).
    """

    layout: Layout
    axes: Mapping[str, tuple[str, ...]]
    lengths: Mapping[str, int]
    tables: Mapping[str, np.ndarray]
    segments: Sequence[str]
    segment: np.ndarray
    row: np.ndarray

    def to_bytes(self) -> bytes:
        """As the bytes of a file."""
        header = {
            "layout": self.layout,
            "axes": {name: list(axes) for name, axes in self.axes.items()},
            "lengths": dict(self.lengths),
            "segments": list(self.segments),
        }
        arrays = {f"table/{name}": table for name, table in self.tables.items()}
        buffer = io.BytesIO()
        np.savez(
            buffer,
            header=np.frombuffer(json.dumps(header).encode(), np.uint8),
            segment=np.asarray(self.segment, np.int32),
            row=np.asarray(self.row, np.int32),
            **arrays,  # type: ignore[arg-type]
        )
        return buffer.getvalue()

    @staticmethod
    def from_bytes(data: bytes) -> Contents:
        """The inverse of `to_bytes`."""
        with np.load(io.BytesIO(data), allow_pickle=False) as stored:
            header = json.loads(stored["header"].tobytes())
            axes = {name: tuple(value) for name, value in header["axes"].items()}
            tables = {name: stored[f"table/{name}"] for name in axes}
            return Contents(
                header["layout"],
                axes,
                header["lengths"],
                tables,
                header["segments"],
                stored["segment"],
                stored["row"],
            )

    def summary(self) -> dict[str, Any]:
        """One digest per field, and the lengths: all that keys of whole products need."""
        fields = {
            name: digest_bytes(repr(table.shape).encode(), np.ascontiguousarray(table).tobytes()).hex()
            for name, table in self.tables.items()
        }
        return {
            "fields": fields,
            "lengths": dict(self.lengths),
            "items": len(self.row),
            "layout": self.layout,
        }


class StoredUnit:
    """Reads the fields of one stored product; every slice read is checked against its digest."""

    def __init__(self, url: str, name: str) -> None:
        self._shelf = open_shelf(url)
        self.name = name
        try:
            self.contents = Contents.from_bytes(self._shelf.read_manifest(name))
        except (*UNREADABLE, EOFError, zipfile.BadZipFile) as error:
            raise DamagedResult(f"manifests/{name}", None, str(error)) from error

    def frames(self, field: str, frames: Sequence[int], camera: int | None = None) -> list[np.ndarray]:
        """Slices of a field that has a frame axis: one array per frame asked for (of one camera, or of all)."""
        contents, axes = self.contents, self.contents.axes[field]
        per_camera = "camera" in axes
        if contents.layout == "view" and per_camera:
            count = contents.lengths["camera"]
            wanted = range(count) if camera is None else [camera]
            views = self._read(
                field,
                [f * count + c for f in frames for c in wanted],
                [(f, c) for f in frames for c in wanted],
            )
            return (
                views
                if camera is not None
                else [np.stack(views[k * count : (k + 1) * count]) for k in range(len(frames))]
            )
        step = contents.lengths["camera"] if contents.layout == "view" else 1
        items = [f * step for f in frames]
        if not per_camera:
            return self._read(field, items, [(f,) for f in frames])
        if camera is None:
            return self._read(field, items, [(f, slice(None)) for f in frames])
        return self._read(field, items, [(f, camera) for f in frames], inside=camera)

    def constant(self, field: str, camera: int | None = None) -> np.ndarray:
        """A field without a frame axis (of one camera, or of all)."""
        contents = self.contents
        if "camera" not in contents.axes[field]:
            return self._read(field, [0], [()])[0]
        if contents.layout == "view" or contents.layout == "whole":
            cameras = range(contents.lengths["camera"]) if camera is None else [camera]
            rows = self._read(field, list(cameras), [(c,) for c in cameras])
        else:
            where: Any = (slice(None),) if camera is None else (camera,)
            return self._read(field, [0], [where], inside=camera)[0]
        return np.stack(rows) if camera is None else rows[0]

    def shape(self, field: str, frame: int = 0) -> tuple[int, ...]:
        """Shape of a field's array in one frame (or of the whole field, without a frame axis), reading no data."""
        contents = self.contents
        item = frame * (contents.lengths.get("camera", 1) if contents.layout == "view" else 1)
        segment, row = self._place(field, item if "frame" in contents.axes[field] else 0)
        reader = self._reader(segment)
        if reader.kind(field) == "whole":
            return reader.whole_shape(field)
        shape = reader.row_shape(field, row)
        stacked = "camera" in contents.axes[field] and (
            contents.layout == "view" or (contents.layout == "whole" and "frame" not in contents.axes[field])
        )
        return (contents.lengths["camera"], *shape) if stacked else shape

    def dtype(self, field: str) -> np.dtype:
        """dtype of a field."""
        return self._reader(self._place(field, 0)[0]).dtype(field)

    def _place(self, field: str, item: int) -> tuple[str, int]:
        contents = self.contents
        if contents.layout == "whole":
            return contents.segments[0], item
        return contents.segments[int(contents.segment[item])], int(contents.row[item])

    def _reader(self, segment: str) -> Any:
        try:
            return self._shelf.reader(segment)
        except UNREADABLE as error:
            raise DamagedResult(segment, None, f"{type(error).__name__}: {error}") from error

    def _read(
        self, field: str, items: Sequence[int], cells: Sequence[tuple[Any, ...]], inside: int | None = None
    ) -> list[np.ndarray]:
        """Rows of a field by item, each checked against the digest table at its cell; `inside` picks a camera."""
        table = self.contents.tables[field]
        places = [self._place(field, item) for item in items]
        out: list[np.ndarray] = [np.empty(0)] * len(items)
        for segment in dict.fromkeys(name for name, _ in places):
            mine = [k for k, (name, _) in enumerate(places) if name == segment]
            arrays = self._load(segment, field, [places[k][1] for k in mine])
            for k, array in zip(mine, arrays, strict=True):
                array = np.asarray(array if inside is None else array[inside])
                expected = table[cells[k]]
                if not np.array_equal(digest_table(array, expected.ndim - 1), expected):
                    rows = [places[k][1]] if self.contents.layout != "whole" else None
                    raise DamagedResult(segment, rows, f"field {field!r} does not match its digest")
                array.setflags(write=False)
                out[k] = array
        return out

    def _load(self, segment: str, field: str, rows: list[int]) -> list[np.ndarray]:
        reader = self._reader(segment)
        try:
            return [reader.whole(field)] if reader.kind(field) == "whole" else reader.rows(field, rows)
        except UNREADABLE as error:
            broken = rows if self.contents.layout != "whole" else None
            raise DamagedResult(segment, broken, f"{type(error).__name__}: {error}") from error


@functools.lru_cache(maxsize=64)
def open_unit(url: str, name: str) -> StoredUnit:
    """A stored product, kept open: manifests never change under one name."""
    return StoredUnit(url, name)


def verify_row(reader: SegmentReader, tables: Mapping[str, np.ndarray], row: int) -> bool:
    """Whether the stored values of one result (a row, or the whole segment) still have their digests."""
    for field, table in tables.items():
        if reader.by_item:
            pairs = [(reader.rows(field, [row])[0], table)]
        elif reader.kind(field) == "whole":
            pairs = [(reader.whole(field), table)]
        else:
            pairs = list(zip(reader.rows(field, range(len(table))), table, strict=True))
        if not all(
            np.array_equal(digest_table(array, digests.ndim - 1), digests) for array, digests in pairs
        ):
            return False
    return True
