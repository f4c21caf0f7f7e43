import json
import struct

import numpy as np
import trimesh

from reperform.nodes.export.gltf import write_sequence_glb, write_surfaces_glb


def parse(path):
    data = path.read_bytes()
    magic, version, total = struct.unpack_from("<4sII", data)
    assert (magic, version, total) == (b"glTF", 2, len(data))
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + length])
    return document, data[28 + length :]


def values(document, blob, index):
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    kind = {5126: np.float32, 5125: np.uint32}[accessor["componentType"]]
    width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
    flat = np.frombuffer(blob, kind, accessor["count"] * width, view["byteOffset"])
    return flat.reshape(accessor["count"], width)


def sequence(frames=4):
    mesh = trimesh.creation.icosphere(subdivisions=1, radius=0.4)
    steps = np.random.default_rng(0).normal(size=(frames, 1, 3)) * 0.1
    return [(mesh.vertices * (1, 2, 0.5) + step).astype(np.float32) for step in steps], mesh.faces.astype(
        np.int32
    )


def test_morph_targets_give_every_frame(tmp_path):
    frames, faces = sequence()
    write_sequence_glb(tmp_path / "a.glb", frames, faces, 25.0, "walk")
    document, blob = parse(tmp_path / "a.glb")
    primitive = document["meshes"][0]["primitives"][0]
    base = values(document, blob, primitive["attributes"]["POSITION"])
    animation = document["animations"][0]
    times = values(document, blob, animation["samplers"][0]["input"])[:, 0]
    weights = values(document, blob, animation["samplers"][0]["output"]).reshape(4, 3)
    np.testing.assert_allclose(times, np.arange(4) / 25, atol=1e-7)
    deltas = [values(document, blob, target["POSITION"]) for target in primitive["targets"]]
    for k, frame in enumerate(frames):
        np.testing.assert_allclose(base + np.tensordot(weights[k], deltas, 1), frame, atol=1e-6)
    np.testing.assert_array_equal(values(document, blob, primitive["indices"]).reshape(-1, 3), faces)


def test_reads_back_with_trimesh_and_texture(tmp_path):
    import cv2

    frames, faces = sequence(1)
    random = np.random.default_rng(1)
    uv = random.uniform(0.1, 0.9, (len(faces) * 3, 2))
    faces_uv = np.arange(len(faces) * 3).reshape(-1, 3)
    image = random.integers(0, 255, (16, 16, 3), dtype=np.uint8)
    png = cv2.imencode(".png", image[..., ::-1])[1].tobytes()
    write_sequence_glb(tmp_path / "a.glb", frames, faces, 25.0, "walk", (uv, faces_uv, png))
    scene = trimesh.load(tmp_path / "a.glb", process=False)
    (mesh,) = scene.geometry.values()
    np.testing.assert_allclose(mesh.triangles, frames[0][faces], atol=1e-6)
    np.testing.assert_allclose(mesh.visual.uv[mesh.faces].reshape(-1, 2), uv, atol=1e-6)
    np.testing.assert_array_equal(np.asarray(mesh.visual.material.baseColorTexture.convert("RGB")), image)


def test_surfaces_show_one_mesh_at_a_time(tmp_path):
    frames, faces = sequence(3)
    meshes = [(frame, faces[: len(faces) - 4 * k]) for k, frame in enumerate(frames)]
    write_surfaces_glb(tmp_path / "a.glb", meshes, 10.0, "hull")
    document, blob = parse(tmp_path / "a.glb")
    assert len(document["nodes"]) == 3
    for k, channel in enumerate(document["animations"][0]["channels"]):
        sampler = document["animations"][0]["samplers"][channel["sampler"]]
        assert (channel["target"], sampler["interpolation"]) == ({"node": k, "path": "scale"}, "STEP")
        np.testing.assert_array_equal(values(document, blob, sampler["output"])[:, 0], np.eye(3)[k])
