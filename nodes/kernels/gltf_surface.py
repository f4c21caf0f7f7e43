"""The meshes of a glTF file as one textured surface whose vertices follow nodes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np

from reperform.nodes.kernels.gltf_file import Gltf

CELL = 512
# texels of a flat-coloured cell that are never sampled, so that neighbours cannot bleed in
FLAT_UV = 0.5


class RiggedSurface(NamedTuple):
    """All meshes merged. vertices (V, 3) at bind, faces (F, 3), uv (N, 2), faces_uv (F, 3), image (H, W, 3);

    vertex v is moved by sum_k weight[v, k] matrix[slot[v, k]], where matrix s is world(node[s]) @ bind[s].
    """

    vertices: np.ndarray
    faces: np.ndarray
    uv: np.ndarray
    faces_uv: np.ndarray
    image: np.ndarray
    slot: np.ndarray
    weight: np.ndarray
    node: np.ndarray
    bind: np.ndarray


def rigged_surface(gltf: Gltf, leave_out: Sequence[str] = ()) -> RiggedSurface:
    """Merge all meshes but those of the nodes named in `leave_out`; vertices that coincide and move alike are one.

    Raises ValueError where no triangles are left, or a name in `leave_out` is unknown.
    """
    carriers = [node.get("name", "") for node in gltf.entries("nodes") if "mesh" in node]
    unknown = [name for name in leave_out if name not in carriers]
    if unknown:
        raise ValueError(
            f"{gltf.name}: has no mesh node {unknown[0]!r} to leave out; it has: {', '.join(carriers)}"
        )
    slots: list[int] = []
    binds: list[np.ndarray] = []
    pieces = []
    for index, node in enumerate(gltf.entries("nodes")):
        if "mesh" not in node or node.get("name", "") in leave_out:
            continue
        base = len(slots)
        skin = gltf.entries("skins")[node["skin"]] if "skin" in node else None
        if skin is None:
            slots.append(index)
            binds.append(np.eye(4))
        else:
            slots.extend(skin["joints"])
            binds.extend(_bind_matrices(gltf, skin))
        for primitive in gltf.entries("meshes")[node["mesh"]]["primitives"]:
            if primitive.get("mode", 4) == 4:
                pieces.append(_piece(gltf, primitive, base, skinned=skin is not None))
    if not pieces:
        raise ValueError(f"{gltf.name}: has no triangles: nothing to show")
    return _merge(gltf, pieces, np.array(slots), np.stack(binds))


class _Piece(NamedTuple):
    position: np.ndarray
    uv: np.ndarray
    faces: np.ndarray
    slot: np.ndarray
    weight: np.ndarray
    material: int


def _bind_matrices(gltf: Gltf, skin: dict) -> np.ndarray:
    if "inverseBindMatrices" not in skin:
        return np.tile(np.eye(4), (len(skin["joints"]), 1, 1))
    return gltf.array(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)


def _piece(gltf: Gltf, primitive: dict, base: int, skinned: bool) -> _Piece:
    attributes = primitive["attributes"]
    position = np.asarray(gltf.array(attributes["POSITION"]), float)
    count = len(position)
    uv = gltf.array(attributes["TEXCOORD_0"]) if "TEXCOORD_0" in attributes else np.zeros((count, 2))
    if "indices" in primitive:
        faces = gltf.array(primitive["indices"])[:, 0].astype(np.int64)
    else:
        faces = np.arange(count)
    faces = faces[: len(faces) // 3 * 3].reshape(-1, 3)
    if faces.size and faces.max() >= count:
        raise ValueError(
            f"{gltf.name}: a face refers to vertex {faces.max()} of {count}: the file is damaged"
        )
    if skinned and "JOINTS_0" in attributes:
        sets = [k for k in range(4) if f"JOINTS_{k}" in attributes]
        slot = np.concatenate([gltf.array(attributes[f"JOINTS_{k}"]) for k in sets], axis=1).astype(np.int64)
        weight = np.concatenate([gltf.array(attributes[f"WEIGHTS_{k}"]) for k in sets], axis=1).astype(float)
        total = weight.sum(axis=1, keepdims=True)
        weight = weight / np.where(total > 0, total, 1)
        weight[total[:, 0] == 0, 0] = 1
    else:
        slot, weight = np.zeros((count, 4), np.int64), np.tile([1.0, 0, 0, 0], (count, 1))
    return _Piece(position, np.asarray(uv, float), faces, slot + base, weight, primitive.get("material", -1))


def _merge(gltf: Gltf, pieces: list[_Piece], node: np.ndarray, bind: np.ndarray) -> RiggedSurface:
    width = max(piece.slot.shape[1] for piece in pieces)
    materials = sorted({piece.material for piece in pieces})
    columns = int(np.ceil(np.sqrt(len(materials))))
    rows = -(-len(materials) // columns)
    image = np.zeros((rows * CELL, columns * CELL, 3), np.uint8)
    textured = {}
    for place, material in enumerate(materials):
        cell, textured[material] = _material(gltf, material)
        y, x = place // columns * CELL, place % columns * CELL
        image[y : y + CELL, x : x + CELL] = cell
    positions, slots, weights, faces, uvs = [], [], [], [], []
    offset = 0
    for piece in pieces:
        place = materials.index(piece.material)
        origin = np.array([place % columns, place // columns])
        corner_uv = piece.uv[piece.faces]
        # repeated textures: each triangle is moved into the first tile
        corner_uv = corner_uv - np.floor(corner_uv.mean(axis=1, keepdims=True))
        if not textured[piece.material]:
            corner_uv = np.full_like(corner_uv, FLAT_UV)
        inner = np.clip(corner_uv, 0.5 / CELL, 1 - 0.5 / CELL)
        uvs.append((inner + origin) / (columns, rows))
        pad = width - piece.slot.shape[1]
        slots.append(np.pad(piece.slot, ((0, 0), (0, pad))))
        weights.append(np.pad(piece.weight, ((0, 0), (0, pad))))
        positions.append(piece.position)
        faces.append(piece.faces + offset)
        offset += len(piece.position)
    corner = np.concatenate(uvs).reshape(-1, 2)
    corner[:, 1] = 1 - corner[:, 1]
    uv, uv_index = np.unique(corner.astype(np.float32), axis=0, return_inverse=True)
    position, slot, weight = np.concatenate(positions), np.concatenate(slots), np.concatenate(weights)
    slot[weight == 0] = 0
    rows_ = np.column_stack([position.astype(np.float32), slot, np.round(weight, 5)])
    _, first, same = np.unique(rows_, axis=0, return_index=True, return_inverse=True)
    welded = same.reshape(-1)[np.concatenate(faces)]
    faces_uv = uv_index.reshape(-1, 3)
    whole = (welded[:, 0] != welded[:, 1]) & (welded[:, 1] != welded[:, 2]) & (welded[:, 2] != welded[:, 0])
    return RiggedSurface(
        position[first], welded[whole].astype(np.int32), uv, faces_uv[whole].astype(np.int32), image,
        slot[first], weight[first], node, bind,
    )  # fmt: skip


def _material(gltf: Gltf, index: int) -> tuple[np.ndarray, bool]:
    """(picture (CELL, CELL, 3) of a material's base colour, whether it comes from a texture)."""
    material = gltf.entries("materials")[index] if index >= 0 else {}
    surface = material.get("pbrMetallicRoughness", {})
    factor = np.array(surface.get("baseColorFactor", [1.0, 1, 1, 1])[:3])
    if "baseColorTexture" in surface:
        source = gltf.entries("textures")[surface["baseColorTexture"]["index"]].get("source", 0)
        picture = cv2.resize(gltf.picture(source), (CELL, CELL), interpolation=cv2.INTER_AREA)
        if not np.allclose(factor, 1):
            # the factor is linear light, the picture is sRGB; a power of 2.2 stands for the curve
            picture = np.rint(np.clip(picture * factor ** (1 / 2.2), 0, 255)).astype(np.uint8)
        return picture, True
    flat = np.rint(255 * np.clip(factor, 0, 1) ** (1 / 2.2)).astype(np.uint8)
    return np.tile(flat, (CELL, CELL, 1)), False
