import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.mesh_geometry import volume
from reperform.nodes.kernels.volume_keeping import with_volume


@pytest.fixture
def body() -> tuple[np.ndarray, np.ndarray]:
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
    return np.asarray(mesh.vertices) + [0.7, 0.4, -0.2], np.asarray(mesh.faces)


def test_a_ball_grows_to_the_radius_of_its_volume(body: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, faces = body
    grown = with_volume(vertices, faces, 1.331 * float(volume(vertices, faces)))
    radius = np.linalg.norm(grown - [0.7, 0.4, -0.2], axis=1)
    np.testing.assert_allclose(radius, 0.55, rtol=2e-4)


def test_any_body_comes_to_its_volume_or_stays_as_it_is(body: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, faces = body
    bent = (vertices * [1.0, 2.0, 0.4] + 0.1 * vertices[:, [1, 2, 0]] ** 2).astype(np.float32)
    own = float(volume(bent, faces))
    np.testing.assert_array_equal(with_volume(bent, faces, own), bent)
    thinner = with_volume(bent, faces, 0.97 * own)
    assert float(volume(thinner, faces)) == pytest.approx(0.97 * own, rel=2e-5)
    assert thinner.dtype == np.float32
