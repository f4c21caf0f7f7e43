"""Digests of arrays, in tables along the item axes of a field: what downstream keys are made of."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping

import numpy as np

from reperform.storage.digest import SIZE, digest_bytes


def digest_array(array: np.ndarray) -> bytes:
    """Digest of dtype, shape and values (text by its characters, whatever the width of the dtype)."""
    if array.dtype.kind in "UT":
        return digest_bytes(b"str", repr(array.shape).encode(), json.dumps(array.tolist()).encode())
    data = np.ascontiguousarray(array)
    state = hashlib.blake2b(f"{array.dtype.str}{array.shape}".encode(), digest_size=SIZE)
    state.update(data.reshape(-1).view(np.uint8).data if data.size else b"")
    return state.digest()


def digest_table(array: np.ndarray, item_axes: int) -> np.ndarray:
    """Digests of every slice along the leading item axes: uint8, shape (*lengths of these axes, 16)."""
    array = np.asarray(array)
    lead = array.shape[:item_axes]
    slices = array.reshape(-1, *array.shape[item_axes:]) if item_axes else array[None]
    digests = b"".join(digest_array(np.asarray(item)) for item in slices)
    return np.frombuffer(digests, np.uint8).reshape(*lead, SIZE)


def pack_tables(tables: Mapping[str, np.ndarray]) -> bytes:
    """Digest tables of the fields of one item as bytes."""
    header = json.dumps({name: table.shape[:-1] for name, table in tables.items()}, separators=(",", ":"))
    return header.encode() + b"\0" + b"".join(table.tobytes() for table in tables.values())


def unpack_tables(packed: bytes) -> dict[str, np.ndarray]:
    """The inverse of `pack_tables`."""
    header, _, data = packed.partition(b"\0")
    tables, at = {}, 0
    for name, lead in json.loads(header).items():
        size = int(np.prod(lead, dtype=int)) * SIZE
        tables[name] = np.frombuffer(data, np.uint8, size, at).reshape(*lead, SIZE)
        at += size
    return tables
