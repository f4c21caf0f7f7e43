import shutil

import numpy as np
import pytest
from scipy.spatial import cKDTree

from reperform.nodes.studio.twin import twin


@pytest.fixture(scope="module")
def folder(data_folder):
    return data_folder / "twin"


def test_vertices_are_those_of_the_skinning(folder):
    take = twin(folder=str(folder), clip="walk", first=10, frames=3, centred=False)
    rest, clip = np.load(folder / "rest.npz"), np.load(folder / "walk.npz")
    transform = np.einsum("vb,tbij->tvij", rest["weights"], clip["transforms"][10:13])
    posed = np.einsum("tvij,vj->tvi", transform[..., :3], rest["vertices"]) + transform[..., 3]
    np.testing.assert_allclose(take.mesh.vertices, posed, atol=1.5e-4)
    assert np.array_equal(take.mesh.faces, rest["faces"])
    assert take.mesh.fps == 25


def test_centring_moves_the_ground_only(folder):
    plain = twin(folder=str(folder), clip="walk", centred=False)
    moved = twin(folder=str(folder), clip="walk")
    shift = plain.mesh.vertices - moved.mesh.vertices
    np.testing.assert_allclose(shift, np.broadcast_to(shift[0, 0], shift.shape), atol=2e-6)
    assert abs(shift[0, 0, 1]) < 1e-6
    hips = moved.skeleton.joints[:, 0]
    np.testing.assert_allclose(hips.min(axis=0)[[0, 2]], -hips.max(axis=0)[[0, 2]], atol=1e-5)
    share = moved.contacts.planted.mean(axis=0)
    assert (share > 0.2).all() and (share < 0.9).all()


def test_the_closed_surface_is_closed_near_the_clothed_one_and_painted_like_it(folder):
    closed = twin(folder=str(folder), clip="walk", watertight=True, first=5, frames=1)
    clothed = twin(folder=str(folder), clip="walk", first=5, frames=1)
    edges = np.sort(closed.mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()

    def shirt(take):
        corners = take.texture.uv[take.texture.faces_uv].mean(axis=1)
        height, width = take.texture.image.shape[:2]
        colour = take.texture.image[
            ((1 - corners[:, 1]) * height).astype(int), (corners[:, 0] * width).astype(int)
        ]
        centres = take.mesh.vertices[0][take.mesh.faces].mean(axis=1)
        return centres, colour.astype(float)

    here, painted = shirt(closed)
    there, wanted = shirt(clothed)
    distance, nearest = cKDTree(there).query(here)
    close = distance < 0.01
    assert close.sum() > 500
    assert np.median(np.abs(painted[close] - wanted[nearest[close]]).max(axis=1)) < 40


def test_what_is_wrong_is_named(folder, tmp_path):
    with pytest.raises(ValueError, match=r"no clip 'wlk'; did you mean 'walk'.* the folder has: jump, run"):
        twin(folder=str(folder), clip="wlk")
    with pytest.raises(ValueError, match=r"rest\.npz does not exist"):
        twin(folder=str(tmp_path), clip="walk")
    for name in ("rest.npz", "atlas.png"):
        shutil.copy(folder / name, tmp_path / name)
    (tmp_path / "walk.npz").write_bytes((folder / "walk.npz").read_bytes()[:5000])
    with pytest.raises(ValueError, match=r"walk\.npz is truncated or damaged"):
        twin(folder=str(tmp_path), clip="walk")
    with pytest.raises(ValueError, match="first must be below the 72 frames of 'walk', got 99"):
        twin(folder=str(folder), clip="walk", first=99)
