"""zarr arrays in a local folder, read and written straight: no event loop and no second thread between a call and its file."""

from __future__ import annotations

import functools
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numcodecs import blosc

# Values of these types are stored as they are; their names are zarr's.
TYPES = frozenset(
    ("bool", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64")
    + ("float16", "float32", "float64", "complex64", "complex128")
)
COMPRESSOR, LEVEL, SHUFFLE = "lz4", 3, 1


def write_group(
    place: Path, attributes: Mapping[str, Any], arrays: Mapping[str, tuple[np.ndarray, tuple[int, ...]]]
) -> None:
    """Write a zarr group (format 3) with its attributes and arrays, each given with the shape of its chunks.

    Chunks cut the first axis only; each is a file `c.K.0...`, compressed by blosc (lz4, level 3, byte shuffle).
    Raises OSError where the folder cannot be written, ValueError for a dtype that zarr has no plain name for.
    """
    place.mkdir(parents=True)
    group = {"attributes": attributes, "zarr_format": 3, "node_type": "group"}
    (place / "zarr.json").write_bytes(json.dumps(group).encode())
    for name, (data, chunk) in arrays.items():
        folder = place / name
        folder.mkdir(parents=True)
        (folder / "zarr.json").write_bytes(_described(data.shape, data.dtype, chunk))
        _write_chunks(str(folder), np.asarray(data, data.dtype.newbyteorder("<"), order="C"), chunk)


def _write_chunks(folder: str, data: np.ndarray, chunk: tuple[int, ...]) -> None:
    if not data.size:
        return
    if not data.ndim:
        _write(f"{folder}/c", data.reshape(1))
        return
    rest = ".0" * (data.ndim - 1)
    for k, first in enumerate(range(0, len(data), chunk[0])):
        block = data[first : first + chunk[0]]
        if len(block) < chunk[0]:
            # every chunk of a zarr array has the same shape
            block = np.concatenate([block, np.zeros((chunk[0] - len(block), *chunk[1:]), data.dtype)])
        _write(f"{folder}/c.{k}{rest}", block)


def _write(path: str, block: np.ndarray) -> None:
    with open(path, "xb", buffering=0) as file:
        packed = memoryview(blosc.compress(block, COMPRESSOR.encode(), LEVEL, SHUFFLE))
        while packed:
            packed = packed[file.write(packed) :]


@functools.lru_cache(maxsize=256)
def _described(shape: tuple[int, ...], dtype: np.dtype, chunk: tuple[int, ...]) -> bytes:
    """The metadata of an array."""
    if dtype.name not in TYPES:
        raise ValueError(f"a stored array must be of one of {', '.join(sorted(TYPES))}, got {dtype}")
    order = {"configuration": {"endian": "little"}} if dtype.itemsize > 1 else {}
    packing = {
        "typesize": dtype.itemsize,
        "cname": COMPRESSOR,
        "clevel": LEVEL,
        "shuffle": "shuffle",
        "blocksize": 0,
    }
    zero: Any = [0.0, 0.0] if dtype.kind == "c" else np.zeros(1, dtype)[0].item()
    described = {
        "shape": shape,
        "data_type": dtype.name,
        "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": chunk}},
        "chunk_key_encoding": {"name": "default", "configuration": {"separator": "."}},
        "fill_value": zero,
        "codecs": [{"name": "bytes", **order}, {"name": "blosc", "configuration": packing}],
        "attributes": {},
        "zarr_format": 3,
        "node_type": "array",
        "storage_transformers": [],
    }
    return json.dumps(described).encode()


class ChunkFolder:
    """A group that `write_group` wrote. Raises FileNotFoundError, ValueError, KeyError or RuntimeError where it is damaged."""

    def __init__(self, place: Path) -> None:
        self._place = os.fspath(place)
        self.attrs: Mapping[str, Any] = _read_json(f"{self._place}/zarr.json")["attributes"]

    def __getitem__(self, name: str) -> ChunkArray:
        return ChunkArray(f"{self._place}/{name}")


class ChunkArray:
    """A stored array that reads the chunks it is asked for: `array[...]` or `array[first:last]`."""

    def __init__(self, folder: str) -> None:
        self._folder = folder
        described = _read_json(f"{folder}/zarr.json")
        self.shape: tuple[int, ...] = tuple(described["shape"])
        self.dtype = np.dtype(described["data_type"]).newbyteorder("<")
        self._chunk: tuple[int, ...] = tuple(described["chunk_grid"]["configuration"]["chunk_shape"])

    def __getitem__(self, rows: Any) -> np.ndarray:
        if not self.shape:
            return self._read("c").reshape(())
        first, last, _ = (slice(None) if rows is Ellipsis else rows).indices(self.shape[0])
        if last <= first or 0 in self.shape:
            return np.zeros((max(last - first, 0), *self.shape[1:]), self.dtype)
        step = self._chunk[0]
        parts = []
        for k in range(first // step, -(-last // step)):
            block = self._read(f"c.{k}{'.0' * (len(self.shape) - 1)}")
            parts.append(block[max(first - k * step, 0) : last - k * step])
        return parts[0] if len(parts) == 1 else np.concatenate(parts)

    def _read(self, name: str) -> np.ndarray:
        with open(f"{self._folder}/{name}", "rb", buffering=0) as file:
            packed = file.read()
        # blosc trusts its header: sizes of what it unpacks at 4, of what it was given at 12
        if len(packed) < 16 or int.from_bytes(packed[12:16], "little") != len(packed):
            raise ValueError(f"chunk {name} is cut or changed: {len(packed)} bytes")
        return np.frombuffer(blosc.decompress(packed), self.dtype).reshape(self._chunk)


def _read_json(path: str) -> Any:
    with open(path, "rb", buffering=0) as file:
        return json.loads(file.read())
