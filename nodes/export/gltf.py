"""Moving, textured meshes as binary glTF 2.0."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

from reperform.nodes.export.atomic import beside
from reperform.nodes.kernels.mesh_geometry import vertex_normals

FLOAT, UNSIGNED = 5126, 5125
ARRAY_BUFFER, ELEMENT_BUFFER = 34962, 34963


class GltfFile:
    """A glTF document under construction: arrays go in, indices of accessors come out."""

    def __init__(self, name: str) -> None:
        self.blob = bytearray()
        # accessor of the key times, shared by all channels
        self.times = -1
        self.document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "reperform"},
            "scene": 0,
            "scenes": [{"name": name, "nodes": []}],
            "nodes": [],
            "meshes": [],
            "materials": [],
            "bufferViews": [],
            "accessors": [],
        }

    def view(self, data: bytes, target: int | None = None) -> int:
        """Append bytes, aligned to four; returns the buffer view."""
        self.blob.extend(b"\0" * (-len(self.blob) % 4))
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self.blob), "byteLength": len(data)}
        if target is not None:
            view["target"] = target
        self.blob.extend(data)
        self.document["bufferViews"].append(view)
        return len(self.document["bufferViews"]) - 1

    def accessor(self, array: np.ndarray, target: int | None = None, bounds: bool = False) -> int:
        """Append an array: float32 (N,), (N, 2), (N, 3), or uint32 (N,)."""
        array = np.ascontiguousarray(array)
        kind = "SCALAR" if array.ndim == 1 else f"VEC{array.shape[1]}"
        accessor: dict[str, Any] = {
            "bufferView": self.view(array.tobytes(), target),
            "componentType": FLOAT if array.dtype == np.float32 else UNSIGNED,
            "count": len(array),
            "type": kind,
        }
        if bounds:
            flat = array.reshape(len(array), -1)
            accessor |= {"min": flat.min(axis=0).tolist(), "max": flat.max(axis=0).tolist()}
        self.document["accessors"].append(accessor)
        return len(self.document["accessors"]) - 1

    def write(self, path: Path) -> None:
        """Write the .glb; complete or absent."""
        self.blob.extend(b"\0" * (-len(self.blob) % 4))
        document = {key: value for key, value in self.document.items() if value != []}
        document["buffers"] = [{"byteLength": len(self.blob)}]
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        header = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(self.blob))
        with beside(path) as draft:
            draft.write_bytes(
                header
                + struct.pack("<I4s", len(text), b"JSON")
                + text
                + struct.pack("<I4s", len(self.blob), b"BIN\0")
                + bytes(self.blob)
            )


def write_sequence_glb(
    path: Path,
    frames: list[np.ndarray],
    faces: np.ndarray,
    fps: float,
    name: str,
    texture: tuple[np.ndarray, np.ndarray, bytes] | None = None,
) -> None:
    """One topology over time: the first frame, and morph targets with an animation that shows frame k at k /
    fps.

    frames: vertices (V, 3) m each; texture: uv (U, 2) with v up, faces_uv (F, 3), and the PNG file's bytes.
    """
    corner = np.arange(len(frames[0]))
    uv = None
    if texture is not None:
        pairs, inverse = np.unique(
            np.stack([faces.ravel(), texture[1].ravel()], 1), axis=0, return_inverse=True
        )
        corner, uv = pairs[:, 0], texture[0][pairs[:, 1]] * (1, -1) + (0, 1)
        drawn = inverse.reshape(-1, 3)
    else:
        drawn = faces
    file = GltfFile(name)
    normals = [vertex_normals(np.asarray(v, np.float64), faces)[corner].astype(np.float32) for v in frames]
    points = [np.asarray(v, np.float32)[corner] for v in frames]
    attributes = {
        "POSITION": file.accessor(points[0], ARRAY_BUFFER, bounds=True),
        "NORMAL": file.accessor(normals[0], ARRAY_BUFFER),
    }
    if uv is not None:
        attributes["TEXCOORD_0"] = file.accessor(uv.astype(np.float32), ARRAY_BUFFER)
    primitive: dict[str, Any] = {
        "attributes": attributes,
        "indices": file.accessor(drawn.astype(np.uint32).ravel(), ELEMENT_BUFFER),
        "material": _material(file, None if texture is None else texture[2]),
    }
    mesh: dict[str, Any] = {"name": name, "primitives": [primitive]}
    if len(frames) > 1:
        primitive["targets"] = [
            {
                "POSITION": file.accessor(points[k] - points[0], ARRAY_BUFFER, bounds=True),
                "NORMAL": file.accessor(normals[k] - normals[0], ARRAY_BUFFER),
            }
            for k in range(1, len(frames))
        ]
        mesh["weights"] = [0.0] * (len(frames) - 1)
        _animate(
            file, np.eye(len(frames), dtype=np.float32)[:, 1:].ravel(), len(frames), fps, "weights", "LINEAR"
        )
    file.document["meshes"].append(mesh)
    file.document["nodes"].append({"name": name, "mesh": 0})
    file.document["scenes"][0]["nodes"].append(0)
    file.write(path)


def write_surfaces_glb(
    path: Path, meshes: list[tuple[np.ndarray, np.ndarray]], fps: float, name: str
) -> None:
    """A topology per frame: one node per frame, shown at its time by a scale that steps between 0 and 1."""
    file = GltfFile(name)
    material = _material(file, None)
    for frame, (vertices, faces) in enumerate(meshes):
        attributes = {
            "POSITION": file.accessor(np.asarray(vertices, np.float32), ARRAY_BUFFER, bounds=True),
            "NORMAL": file.accessor(
                vertex_normals(np.asarray(vertices, np.float64), faces).astype(np.float32), ARRAY_BUFFER
            ),
        }
        indices = file.accessor(faces.astype(np.uint32).ravel(), ELEMENT_BUFFER)
        label = f"{name}_{frame:05d}"
        file.document["meshes"].append(
            {
                "name": label,
                "primitives": [{"attributes": attributes, "indices": indices, "material": material}],
            }
        )
        hidden = frame > 0
        file.document["nodes"].append(
            {"name": label, "mesh": frame} | ({"scale": [0, 0, 0]} if hidden else {})
        )
        file.document["scenes"][0]["nodes"].append(frame)
    for frame in range(len(meshes) if len(meshes) > 1 else 0):
        scale = np.zeros((len(meshes), 3), np.float32)
        scale[frame] = 1
        _animate(file, scale, len(meshes), fps, "scale", "STEP", frame)
    file.write(path)


def _material(file: GltfFile, png: bytes | None) -> int:
    surface: dict[str, Any] = {"metallicFactor": 0.0, "roughnessFactor": 1.0}
    if png is None:
        surface["baseColorFactor"] = [0.8, 0.76, 0.7, 1.0]
    else:
        file.document["images"] = [{"mimeType": "image/png", "bufferView": file.view(png)}]
        file.document["samplers"] = [{"wrapS": 33071, "wrapT": 33071}]
        file.document["textures"] = [{"source": 0, "sampler": 0}]
        surface["baseColorTexture"] = {"index": 0}
    file.document["materials"].append({"pbrMetallicRoughness": surface, "doubleSided": True})
    return len(file.document["materials"]) - 1


def _animate(
    file: GltfFile, values: np.ndarray, count: int, fps: float, path: str, interpolation: str, node: int = 0
) -> None:
    """Add a channel to the file's one animation; key k is at k / fps."""
    if "animations" not in file.document:
        file.times = file.accessor(np.arange(count, dtype=np.float32) / np.float32(fps), bounds=True)
        file.document["animations"] = [{"name": "performance", "channels": [], "samplers": []}]
        file.document["animations"][0]["extras"] = {"fps": float(fps)}
    animation = file.document["animations"][0]
    animation["samplers"].append(
        {"input": file.times, "output": file.accessor(values), "interpolation": interpolation}
    )
    animation["channels"].append(
        {"sampler": len(animation["samplers"]) - 1, "target": {"node": node, "path": path}}
    )
