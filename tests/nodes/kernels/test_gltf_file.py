import json
import struct

import cv2
import numpy as np
import pytest

from reperform.nodes.kernels.gltf_file import (
    by_depth,
    global_matrices,
    local_transforms,
    node_parents,
    read_glb,
)


def glb(description: dict, binary: bytes = b"") -> bytes:
    text = json.dumps(description).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = (
        struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    )
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


NODES = [
    {"name": "tip", "translation": [0, 2, 0]},
    {"name": "root", "children": [2], "rotation": [0, 0, np.sqrt(0.5), np.sqrt(0.5)], "scale": [2, 2, 2]},
    {"name": "middle", "children": [0], "matrix": [0, 0, -3, 0, 0, 1, 0, 0, 1, 0, 0, 0, 5, 6, 7, 1]},
]


@pytest.fixture
def write(tmp_path):
    def save(data: bytes):
        path = tmp_path / "thing.glb"
        path.write_bytes(data)
        return path

    return save


def test_arrays_of_all_layouts(write):
    floats = np.arange(12, dtype="<f4").reshape(4, 3)
    interleaved = np.zeros((3, 8), np.uint8)
    interleaved[:, :4] = [[0, 51, 255, 1], [2, 3, 4, 5], [6, 7, 8, 9]]
    data = floats.tobytes() + interleaved.tobytes()
    description = {
        "bufferViews": [{"byteLength": 48}, {"byteOffset": 48, "byteLength": 24, "byteStride": 8}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3, "byteOffset": 12},
            {"bufferView": 1, "componentType": 5121, "type": "VEC2", "count": 3, "normalized": True},
            {"bufferView": 1, "componentType": 5121, "type": "VEC4", "count": 3},
            {"componentType": 5126, "type": "SCALAR", "count": 2},
        ],
    }
    gltf = read_glb(write(glb(description, data)))
    np.testing.assert_array_equal(gltf.array(0), floats[1:])
    np.testing.assert_allclose(gltf.array(1)[0], [0, 0.2])
    assert gltf.array(2)[2].tolist() == [6, 7, 8, 9]
    assert not gltf.array(3).any()


def test_pictures_are_rgb(write):
    picture = np.zeros((3, 5, 3), np.uint8)
    picture[1, 2] = (250, 20, 3)
    encoded = cv2.imencode(".png", picture[..., ::-1])[1].tobytes()
    description = {"images": [{"bufferView": 0}], "bufferViews": [{"byteLength": len(encoded)}]}
    assert np.array_equal(read_glb(write(glb(description, encoded))).picture(0), picture)


def test_transforms_compose_down_the_tree(write):
    gltf = read_glb(write(glb({"nodes": NODES})))
    parents = node_parents(gltf)
    assert parents.tolist() == [2, -1, 1]
    assert by_depth(parents) == [1, 2, 0]
    world = global_matrices(parents, *(values[None] for values in local_transforms(gltf)))[0]
    root = np.array([[0, -2, 0, 0], [2, 0, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1.0]])
    middle = np.array(NODES[2]["matrix"], float).reshape(4, 4).T
    tip = np.eye(4)
    tip[1, 3] = 2
    np.testing.assert_allclose(world[0], root @ middle @ tip, atol=1e-9)


def test_damage_is_named(write, tmp_path):
    whole = glb({"nodes": NODES})
    with pytest.raises(
        ValueError, match=r"thing\.glb: must have \d+ bytes by its header, got \d+: it is truncated"
    ):
        read_glb(write(whole[:-10]))
    with pytest.raises(ValueError, match=r"must be a binary glTF \(\.glb\), got b'PK"):
        read_glb(write(b"PK\x03\x04" + whole[4:]))
    with pytest.raises(ValueError, match="must be glTF version 2, got 1"):
        read_glb(write(whole[:4] + struct.pack("<I", 1) + whole[8:]))
    with pytest.raises(ValueError, match="description is not JSON"):
        read_glb(write(whole.replace(b'"nodes"', b'"nodes,')))
    with pytest.raises(ValueError, match="requires KHR_draco_mesh_compression"):
        read_glb(write(glb({"extensionsRequired": ["KHR_draco_mesh_compression"]})))
    with pytest.raises(ValueError, match="cannot be read: No such file"):
        read_glb(tmp_path / "absent.glb")
    short = {
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 9}],
        "bufferViews": [{}],
    }
    with pytest.raises(ValueError, match="accessor 0 needs 108 bytes of binary data, the file holds 8"):
        read_glb(write(glb(short, b"12345678"))).array(0)
