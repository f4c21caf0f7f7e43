"""zarr arrays on an object store, by zarr itself, which keeps many requests under way at a time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import zarr
from zarr.codecs import BloscCodec


def write_zarr_group(
    store: Any,
    path: str,
    attributes: Mapping[str, Any],
    arrays: Mapping[str, tuple[np.ndarray, tuple[int, ...]]],
) -> None:
    """Write what `chunk_folder.write_group` writes, at `path` of a zarr store."""
    group = zarr.create_group(store, path=path, attributes=dict(attributes))
    for name, (data, chunk) in arrays.items():
        array = group.create_array(
            name,
            shape=data.shape,
            dtype=data.dtype,
            chunks=chunk,
            compressors=[BloscCodec(cname="lz4", clevel=3, shuffle="shuffle")],
            chunk_key_encoding={"name": "default", "separator": "."},
            # zeros are data too: a chunk that is missing is damage, never a fill value
            config={"write_empty_chunks": True},
        )
        if data.size:
            array[...] = data


def open_zarr_group(store: Any, path: str) -> Any:
    """The group at `path` of a zarr store: its attributes as `attrs`, its arrays by name."""
    return zarr.open_group(store, path=path, mode="r")
