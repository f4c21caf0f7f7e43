import numpy as np
import pytest
import trimesh

from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.studio.rig import rig
from reperform.nodes.studio.true_mattes import true_mattes


def ellipsoid() -> MeshSequence:
    mesh = trimesh.creation.icosphere(4)
    vertices = mesh.vertices * (0.3, 0.8, 0.2) + (0.2, 0.9, -0.1)
    return MeshSequence(vertices.astype(np.float32), mesh.faces.astype(np.int32), np.array(25, np.float32))


@pytest.mark.parametrize("index", [0, 2, 5])
def test_the_matte_of_an_ellipsoid_is_its_outline_conic(index):
    cameras = rig(width=480, picture_height=270)
    matte = true_mattes(ellipsoid(), type(cameras)(*(field[index] for field in cameras)), supersampling=8)
    # the outline of a quadric Q* seen by P is the dual conic P Q* P^T
    shape = np.diag([0.3**2, 0.8**2, 0.2**2, -1.0])
    place = np.eye(4)
    place[:3, 3] = (0.2, 0.9, -0.1)
    projection = cameras.matrix[index] @ np.column_stack(
        [cameras.rotation[index], cameras.translation[index]]
    )
    dual = projection @ place @ shape @ place.T @ projection.T
    conic = np.linalg.inv(dual)
    area = np.pi * np.abs(np.linalg.det(conic)) / np.abs(np.linalg.det(conic[:2, :2])) ** 1.5
    assert matte.alpha.sum() / 255 == pytest.approx(area, rel=0.006)
    ys, xs = np.indices(matte.alpha.shape)
    middle = -np.linalg.solve(conic[:2, :2], conic[:2, 2])
    total = matte.alpha.sum(dtype=float)
    assert (matte.alpha * xs).sum() / total == pytest.approx(middle[0], abs=0.1)
    assert (matte.alpha * ys).sum() / total == pytest.approx(middle[1], abs=0.1)


def test_supersampling_converges():
    cameras = rig(width=160, picture_height=90)
    view = type(cameras)(*(field[1] for field in cameras))
    fine = true_mattes(ellipsoid(), view, supersampling=16).alpha.astype(float)
    errors = [
        np.abs(true_mattes(ellipsoid(), view, supersampling=s).alpha - fine).sum() for s in (1, 2, 4, 8)
    ]
    assert sorted(errors, reverse=True) == errors
