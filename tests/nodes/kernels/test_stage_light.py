import numpy as np
import trimesh

from reperform.nodes.kernels.camera import look_at
from reperform.nodes.kernels.stage_light import cyclorama, lambert, shadow_map


def seen(unevenness: float, shadow=None, strength: float = 0.0) -> np.ndarray:
    rotation, translation = look_at(np.array([1.0, 2.4, 4.0]), np.array([0.2, 0.6, 0.0]))
    matrix = np.array([[300.0, 0, 99.5], [0, 300.0, 60.0], [0, 0, 1]])
    return cyclorama(matrix, rotation, translation, np.array([203, 121]), unevenness, shadow, strength)


def body() -> tuple[np.ndarray, np.ndarray]:
    mesh = trimesh.creation.capsule(1.2, 0.2)
    vertices = mesh.vertices[:, [0, 2, 1]]
    vertices[:, 1] -= vertices[:, 1].min()
    return (vertices + (0.3, 0, -0.2)).astype(np.float32), mesh.faces[:, ::-1].astype(np.int32)


def test_even_light_is_one_everywhere():
    light = seen(0.0)
    assert light.shape == (121, 203)
    np.testing.assert_allclose(light, 1, atol=1e-6)


def test_uneven_light_is_smooth_and_bounded():
    light = seen(0.2)
    assert light.std() > 0.01
    assert np.abs(light - 1).max() < 0.5
    assert np.abs(np.diff(light, axis=1)).max() < 0.02


def test_the_shadow_lies_under_the_body_and_fades():
    loss, corner = shadow_map(*body())
    cell = 4.8 / len(loss)
    z, x = np.unravel_index(loss.argmax(), loss.shape)
    assert np.hypot(corner[0] + x * cell - 0.3, corner[1] + z * cell + 0.2) < 0.22
    assert 0.2 < loss.max() < 1
    assert loss[0].max() < 0.01
    dark = seen(0.0, (loss, corner), 1.0)
    assert dark.min() < 0.9 and np.isclose(np.median(dark), 1, atol=0.05)
    assert dark.min() < seen(0.0, (loss, corner), 0.4).min()


def test_a_raised_body_has_a_weaker_shadow():
    vertices, faces = body()
    high = vertices + np.array([0, 0.5, 0], np.float32)
    assert shadow_map(high, faces)[0].max() < shadow_map(vertices, faces)[0].max()


def test_light_comes_from_above_and_is_never_dark():
    normals = trimesh.creation.icosphere(2).vertices
    light = lambert(normals)
    assert light.min() > 0.15 and light.max() < 1.6
    assert light[normals[:, 1].argmax()] > light[normals[:, 1].argmin()]
