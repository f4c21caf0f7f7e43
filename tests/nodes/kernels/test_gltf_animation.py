import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from reperform.nodes.kernels.gltf_animation import (
    clip_names,
    clip_seconds,
    find_clip,
    interpolate_keys,
    sample_clip,
)
from reperform.nodes.kernels.gltf_file import Gltf

KEYS = np.array([0.5, 1.0, 2.0])
VALUES = np.array([[1.0, 0, 3], [2, 4, -1], [0, 0, 0]])


def test_linear_step_and_the_ends():
    times = np.array([0.0, 0.75, 1.0, 1.5, 9.0])
    linear = interpolate_keys(KEYS, VALUES, times, "LINEAR", False)
    np.testing.assert_allclose(linear, [[1, 0, 3], [1.5, 2, 1], [2, 4, -1], [1, 2, -0.5], [0, 0, 0]])
    step = interpolate_keys(KEYS, VALUES, times, "STEP", False)
    np.testing.assert_allclose(step, [[1, 0, 3], [1, 0, 3], [2, 4, -1], [2, 4, -1], [0, 0, 0]])


def test_rotations_take_the_short_way_like_scipy():
    rotations = Rotation.from_rotvec([[0, 0.4, 0], [1.5, 0.2, -0.3], [-0.2, 2.0, 0.1]])
    quaternions = rotations.as_quat()
    quaternions[1] *= -1
    times = np.linspace(0.5, 2, 13)
    found = Rotation.from_quat(interpolate_keys(KEYS, quaternions, times, "LINEAR", True))
    assert (found * Slerp(KEYS, rotations)(times).inv()).magnitude().max() < 1e-7


def test_cubic_splines_reproduce_a_cubic():
    def value(t):
        return np.column_stack([t**3 - t, 2 * t**2])

    def slope(t):
        return np.column_stack([3 * t**2 - 1, 4 * t])

    stored = np.stack([slope(KEYS), value(KEYS), slope(KEYS)], axis=1).reshape(-1, 2)
    times = np.linspace(0.5, 2, 11)
    np.testing.assert_allclose(
        interpolate_keys(KEYS, stored, times, "CUBICSPLINE", False), value(times), atol=1e-12
    )


def test_one_key_holds():
    np.testing.assert_allclose(
        interpolate_keys(KEYS[:1], VALUES[:1], np.array([0.0, 3.0]), "LINEAR", False), VALUES[[0, 0]]
    )


@pytest.fixture
def gltf() -> Gltf:
    data = np.concatenate([KEYS, VALUES.ravel()]).astype("<f4").tobytes()
    description = {
        "nodes": [{}, {"translation": [9, 9, 9], "scale": [2, 2, 2]}],
        "bufferViews": [{"byteLength": 12}, {"byteOffset": 12, "byteLength": 36}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "SCALAR", "count": 3},
            {"bufferView": 1, "componentType": 5126, "type": "VEC3", "count": 3},
        ],
        "animations": [
            {"name": "Walk", "samplers": [{"input": 0, "output": 1}],
             "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}},
                          {"sampler": 0, "target": {"node": 1, "path": "weights"}}]},
            {"samplers": [], "channels": []},
        ],
    }  # fmt: skip
    return Gltf("some.glb", description, data)


def test_a_clip_moves_its_nodes_only(gltf):
    translation, rotation, scale = sample_clip(gltf, 0, np.array([0.75]))
    np.testing.assert_allclose(translation[0], [[0, 0, 0], [1.5, 2, 1]])
    np.testing.assert_allclose(rotation[0], [[0, 0, 0, 1]] * 2)
    np.testing.assert_allclose(scale[0, 1], 2)
    assert clip_seconds(gltf, 0) == 2 and clip_seconds(gltf, 1) == 0


def test_clips_are_found_by_name(gltf):
    assert clip_names(gltf) == ["Walk", "clip 1"]
    assert find_clip(gltf, "Walk") == find_clip(gltf, "walk") == 0
    with pytest.raises(
        ValueError, match=r"some\.glb: has no clip 'Walks'; did you mean 'Walk'\? it has: Walk, clip 1"
    ):
        find_clip(gltf, "Walks")
    with pytest.raises(ValueError, match="has no animation clips"):
        find_clip(Gltf("bare.glb", {}, b""), "Walk")
