import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.camera import centre, project
from reperform.nodes.products.mesh import MeshSequence, Surfaces
from reperform.nodes.ragged import Ragged
from reperform.nodes.texture.orbit import orbit


def walk(frames: int = 11) -> MeshSequence:
    mesh = trimesh.creation.box((0.4, 1.8, 0.3))
    steps = np.linspace(0, 2, frames)[:, None, None] * np.array([1, 0, 0.5]) + (0.2, 0.9, -0.1)
    return MeshSequence(
        (mesh.vertices + steps).astype(np.float32), mesh.faces.astype(np.int32), np.float32(10)
    )


def test_the_performer_stays_in_the_middle_at_the_given_distance():
    mesh = walk()
    path = orbit(mesh, radius=3, height=1.2, degrees=90, start=30, smooth=0, width=300, picture_height=200)
    eyes = centre(path.rotation, path.translation)
    middles = mesh.vertices.mean(axis=1)
    away = eyes - middles
    np.testing.assert_allclose(np.linalg.norm(away[:, [0, 2]], axis=1), 3, atol=1e-5)
    np.testing.assert_allclose(eyes[:, 1], 1.2)
    np.testing.assert_allclose(
        np.degrees(np.arctan2(away[:, 0], away[:, 2])), np.linspace(30, 120, 11), atol=1e-3
    )
    for k in range(11):
        pixel, _ = project(middles[k : k + 1], path.matrix[k], path.rotation[k], path.translation[k])
        np.testing.assert_allclose(pixel[0], [149.5, 99.5], atol=1e-3)
    assert path.image_size.tolist() == [300, 200]
    assert path.matrix[0, 0, 0] == pytest.approx(100 / np.tan(np.radians(17)))


def test_a_still_camera_stands_still():
    path = orbit(walk(), degrees=0, follow=False)
    assert (path.translation == path.translation[0]).all()
    assert (path.rotation == path.rotation[0]).all()


def test_smoothing_takes_the_jitter_out():
    mesh = walk(60)
    jitter = np.random.default_rng(0).normal(size=(60, 1, 3)).astype(np.float32) * 0.05
    steps = [
        np.abs(np.diff(centre(path.rotation, path.translation), 2, axis=0)).max()
        for path in (
            orbit(mesh._replace(vertices=mesh.vertices + jitter), degrees=0, smooth=s) for s in (0, 1)
        )
    ]
    assert steps[1] < 0.1 * steps[0]


def test_surfaces_and_a_mesh_give_the_same():
    mesh = walk()
    surfaces = Surfaces(Ragged(list(mesh.vertices)), Ragged([mesh.faces] * 11), mesh.fps)
    for a, b in zip(orbit(mesh), orbit(None, surfaces), strict=True):
        np.testing.assert_array_equal(a, b)


def test_refuses_no_mesh_both_or_an_empty_one():
    mesh = walk()
    surfaces = Surfaces(Ragged(list(mesh.vertices)), Ragged([mesh.faces[:0]] * 11), mesh.fps)
    with pytest.raises(ValueError, match="got neither"):
        orbit()
    with pytest.raises(ValueError, match="got both"):
        orbit(mesh, surfaces)
    with pytest.raises(ValueError, match="frame 0 has no surface"):
        orbit(None, surfaces)
