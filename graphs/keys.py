"""The keys of the cache: node, code, canonical parameters and digests of inputs; nothing else.

A unit is one output of a step (a take, a pair or the only one); its key answers for all of its items at once. An item is
what one call computes; its key holds the digests of exactly the slices that the call sees.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from reperform.nodes.catalogue import NodeSpec
from reperform.storage.digest import SIZE, digest_bytes
from reperform.storage.manifest import Contents


def code_key(node: NodeSpec, parameters: bytes) -> bytes:
    """What node, code and parameters contribute to every key of a unit."""
    return digest_bytes(b"reperform 1", node.name.encode(), node.fingerprint.encode(), parameters)


def product_digest(summary: Mapping[str, object], part: str) -> bytes:
    """Digest of a stored product, or of the product inside it that `part` names, from its manifest's summary."""
    fields: Mapping[str, str] = summary["fields"]  # type: ignore[assignment]
    prefix = f"{part}." if part else ""
    inside = sorted((name[len(prefix) :], value) for name, value in fields.items() if name.startswith(prefix))
    return digest_bytes(*(text.encode() for pair in inside for text in pair))


def unit_key(code: bytes, ports: Sequence[tuple[str, Sequence[tuple[str, bytes]]]]) -> bytes:
    """Key of a whole unit. ports: (port, its (label, digest) pairs in order), in the order of the signature."""
    parts = [code]
    for name, inputs in ports:
        parts += [name.encode(), len(inputs).to_bytes(4, "little")]
        for label, digest in inputs:
            parts += [label.encode(), digest]
    return digest_bytes(b"unit", *parts)


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
