"""Binary glTF 2.0 files: their description, arrays, pictures and nodes."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from scipy.spatial.transform import Rotation

_MAGIC = 0x46546C67
_COMPONENT = {
    5120: np.int8,
    5121: np.uint8,
    5122: np.int16,
    5123: np.uint16,
    5125: np.uint32,
    5126: np.float32,
}
_WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}


@dataclass(frozen=True)
class Gltf:
    """A file's JSON description and its binary chunk."""

    name: str
    json: dict[str, Any]
    binary: bytes

    def array(self, index: int) -> np.ndarray:
        """Accessor `index` as (count, width) float64, or its integer type where it is not normalised.

        Raises ValueError where it reaches past the end of the data or is sparse.
        """
        accessor = self._entry("accessors", index)
        if "sparse" in accessor:
            raise ValueError(f"{self.name}: accessor {index} is sparse, which is not read: export it dense")
        dtype, width, count = (
            _COMPONENT[accessor["componentType"]],
            _WIDTH[accessor["type"]],
            accessor["count"],
        )
        size = np.dtype(dtype).itemsize * width
        if "bufferView" not in accessor:
            return np.zeros((count, width))
        view = self._entry("bufferViews", accessor["bufferView"])
        stride = view.get("byteStride", size)
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        end = start + stride * max(count - 1, 0) + size
        if end > len(self.binary):
            raise ValueError(
                f"{self.name}: accessor {index} needs {end} bytes of binary data, the file holds "
                f"{len(self.binary)}: the file is truncated or damaged"
            )
        raw = np.ndarray((count, size), np.uint8, self.binary, start, (stride, 1))
        values = np.ascontiguousarray(raw).view(dtype).reshape(count, width)
        if dtype is np.float32:
            return values.astype(np.float64)
        if accessor.get("normalized"):
            return np.maximum(values / float(np.iinfo(values.dtype).max), -1.0)
        return values

    def picture(self, index: int) -> np.ndarray:
        """Image `index` as (H, W, 3) uint8 RGB. Raises ValueError where it is not embedded or cannot be decoded."""
        image = self._entry("images", index)
        if "bufferView" not in image:
            raise ValueError(f"{self.name}: image {index} is not embedded: export with textures embedded")
        view = self._entry("bufferViews", image["bufferView"])
        start = view.get("byteOffset", 0)
        encoded = np.frombuffer(self.binary[start : start + view["byteLength"]], np.uint8)
        decoded = cv2.imdecode(encoded, cv2.IMREAD_COLOR) if len(encoded) else None
        if decoded is None:
            raise ValueError(
                f"{self.name}: image {index} cannot be decoded: the file is truncated or damaged"
            )
        return np.ascontiguousarray(decoded[..., ::-1])

    def entries(self, kind: str) -> list[dict[str, Any]]:
        """All entries of a top-level list, such as `nodes`."""
        return self.json.get(kind, [])

    def _entry(self, kind: str, index: int) -> dict[str, Any]:
        entries = self.entries(kind)
        if not 0 <= index < len(entries):
            raise ValueError(
                f"{self.name}: entry {index} of {kind} is referred to but there are {len(entries)}"
            )
        return entries[index]


def read_glb(path: Path) -> Gltf:
    """Read a .glb file. Raises ValueError that says what is wrong with a file that is not whole glTF 2.0."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ValueError(f"{path}: cannot be read: {error.strerror}") from error
    if len(data) < 20 or struct.unpack("<I", data[:4])[0] != _MAGIC:
        raise ValueError(
            f"{path.name}: must be a binary glTF (.glb), got {data[:4]!r} at its start: export as .glb"
        )
    version, length = struct.unpack("<II", data[4:12])
    if version != 2:
        raise ValueError(f"{path.name}: must be glTF version 2, got {version}: export it again as glTF 2.0")
    if len(data) < length:
        raise ValueError(
            f"{path.name}: must have {length} bytes by its header, got {len(data)}: it is truncated"
        )
    chunks: dict[bytes, bytes] = {}
    offset = 12
    while offset + 8 <= length:
        size, kind = struct.unpack("<I4s", data[offset : offset + 8])
        chunks.setdefault(kind, data[offset + 8 : offset + 8 + size])
        offset += 8 + size
    try:
        description = json.loads(chunks.get(b"JSON", b""))
    except ValueError as error:
        raise ValueError(
            f"{path.name}: its description is not JSON ({error}): the file is damaged"
        ) from error
    required = description.get("extensionsRequired", [])
    if required:
        raise ValueError(f"{path.name}: requires {', '.join(required)}, which is not read: export without it")
    return Gltf(path.name, description, chunks.get(b"BIN\x00", b""))


def node_parents(gltf: Gltf) -> np.ndarray:
    """Parent of every node (-1 for roots)."""
    nodes = gltf.entries("nodes")
    parents = np.full(len(nodes), -1)
    for index, node in enumerate(nodes):
        parents[node.get("children", [])] = index
    return parents


def local_transforms(gltf: Gltf) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rest translation (N, 3), rotation quaternion x y z w (N, 4) and scale (N, 3) of every node."""
    nodes = gltf.entries("nodes")
    translation, rotation = np.zeros((len(nodes), 3)), np.tile([0.0, 0, 0, 1], (len(nodes), 1))
    scale = np.ones((len(nodes), 3))
    for index, node in enumerate(nodes):
        if "matrix" in node:
            matrix = np.array(node["matrix"], float).reshape(4, 4).T
            translation[index] = matrix[:3, 3]
            scale[index] = np.linalg.norm(matrix[:3, :3], axis=0)
            if np.linalg.det(matrix[:3, :3]) < 0:
                scale[index, 0] *= -1
            rotation[index] = Rotation.from_matrix(matrix[:3, :3] / scale[index]).as_quat()
        translation[index] = node.get("translation", translation[index])
        rotation[index] = node.get("rotation", rotation[index])
        scale[index] = node.get("scale", scale[index])
    return translation, rotation, scale


def global_matrices(
    parents: np.ndarray, translation: np.ndarray, rotation: np.ndarray, scale: np.ndarray
) -> np.ndarray:
    """World matrices (T, N, 4, 4) of all nodes from local transforms (T, N, ...)."""
    frames, count = translation.shape[:2]
    local = np.tile(np.eye(4), (frames, count, 1, 1))
    turn = Rotation.from_quat(rotation.reshape(-1, 4)).as_matrix().reshape(frames, count, 3, 3)
    local[..., :3, :3] = turn * scale[..., None, :]
    local[..., :3, 3] = translation
    world = local.copy()
    for index in by_depth(parents):
        if parents[index] >= 0:
            world[:, index] = world[:, parents[index]] @ local[:, index]
    return world


def by_depth(parents: np.ndarray) -> list[int]:
    """Indices in an order in which parents come before children."""
    depth = np.zeros(len(parents), int)
    for index in range(len(parents)):
        above = parents[index]
        while above >= 0:
            depth[index] += 1
            above = parents[above]
    return [int(index) for index in np.argsort(depth, kind="stable")]
