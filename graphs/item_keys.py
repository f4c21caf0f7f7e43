"""The keys of items. An item is what one call computes; its key holds the digests of exactly the slices that it sees."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reperform.graphs.keys import unit_key
from reperform.storage.digest import SIZE, digest_bytes
from reperform.storage.manifest import Contents


@dataclass(frozen=True)
class SlicedPort:
    """A port whose product is cut into items, and the digests to cut."""

    name: str
    contents: Contents
    part: str
    by_frame: bool
    by_camera: bool

    def tables(self) -> dict[str, np.ndarray]:
        """Digest tables of the fields of the part, by name."""
        prefix = f"{self.part}." if self.part else ""
        tables = self.contents.tables
        return {name: tables[name] for name in sorted(tables) if name.startswith(prefix)}


def item_keys(
    code: bytes,
    ports: Sequence[SlicedPort],
    whole: Sequence[tuple[str, Sequence[tuple[str, bytes]]]],
    frames: int,
    cameras: int | None,
    window: tuple[int, int],
) -> list[bytes]:
    """Keys of all items of a frame node (cameras None) or a view node (frame-major order).

    whole: the ports that every call sees whole, as in `unit_key`.
    """
    constant = [unit_key(code, whole)]
    varying: list[np.ndarray] = []
    for port in ports:
        for name, table in port.tables().items():
            axes = port.contents.axes[name]
            by_frame = port.by_frame and "frame" in axes
            by_camera = port.by_camera and "camera" in axes
            constant.append(digest_bytes(port.name.encode(), name.encode(), bytes([by_frame, by_camera])))
            if not by_frame and not by_camera:
                constant.append(
                    digest_bytes(repr(table.shape).encode(), np.ascontiguousarray(table).tobytes())
                )
                continue
            cut = table if by_frame else np.broadcast_to(table, (frames, *table.shape))
            if cameras is None:
                varying.append(cut.reshape(frames, -1))
            elif by_camera:
                varying.append(cut.reshape(frames, cameras, -1))
            else:
                varying.append(np.broadcast_to(cut.reshape(frames, 1, -1), (frames, cameras, cut[0].size)))
    prefix = digest_bytes(b"item", *constant)
    if cameras is not None:
        rows = np.ascontiguousarray(np.concatenate(varying, axis=2)).reshape(frames * cameras, -1)
    else:
        rows = np.ascontiguousarray(np.concatenate(varying, axis=1))
    width, data = rows.shape[1], rows.tobytes()
    if window == (0, 0):
        return [_hash(prefix, data[k * width : (k + 1) * width]) for k in range(len(rows))]
    before, after = window
    keys = []
    for k in range(frames):
        low, high = max(0, k - before), min(frames, k + after + 1)
        keys.append(_hash(prefix, (k - low).to_bytes(4, "little") + data[low * width : high * width]))
    return keys


def _hash(prefix: bytes, row: bytes) -> bytes:
    return hashlib.blake2b(prefix + row, digest_size=SIZE).digest()


def length(axis: str, ports: Sequence[SlicedPort], node: str) -> int:
    """The length of an item axis, on which all ports cut along it must agree. Raises ValueError where they do not."""
    lengths = {port.name: port.contents.lengths[axis] for port in ports}
    if not lengths:
        raise ValueError(f"node {node} works by {axis}, but no input has {axis}s")
    if len(set(lengths.values())) > 1:
        told = ", ".join(f"{name!r} has {count}" for name, count in lengths.items())
        raise ValueError(
            f"node {node}: inputs must have the same number of {axis}s, but {told}: cut them to the same {axis}s"
        )
    found = next(iter(lengths.values()))
    if found == 0:
        raise ValueError(f"node {node}: its inputs have no {axis}s at all: look at the step before")
    return found
