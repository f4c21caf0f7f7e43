import numpy as np

from reperform.nodes.kernels.face_poses import decompose, face_frames
from reperform.nodes.kernels.laplacian import deformation_gradients
from reperform.nodes.kernels.quaternion import to_matrix
from reperform.nodes.kernels.rotation import polar


def _scene():
    random = np.random.default_rng(4)
    reference = random.normal(size=(40, 3)) + [2.0, -1.0, 0.5]
    faces = np.array([random.choice(40, 3, replace=False) for _ in range(60)], np.int32)
    return reference, random.normal(size=(40, 3)), faces


def _matrices(quaternions):
    out = np.empty((len(quaternions), 3, 3))
    for q, r in zip(quaternions, out, strict=True):
        to_matrix(q, r)
    return out


def test_the_closed_form_is_the_polar_factor_of_the_deformation_gradient():
    reference, posed, faces = _scene()
    frames = face_frames(reference, faces)
    rotation, stretch = decompose(posed, faces, frames.axes, frames.edges)
    r, s = polar(deformation_gradients(reference, posed, faces))
    np.testing.assert_allclose(_matrices(rotation), r, atol=1e-9)
    plane = np.zeros((len(faces), 3, 3))
    plane[:, 0, 0], plane[:, 1, 1], plane[:, 2, 2] = stretch[:, 0], stretch[:, 2], 1.0
    plane[:, 0, 1] = plane[:, 1, 0] = stretch[:, 1]
    np.testing.assert_allclose(frames.axes @ plane @ frames.axes.transpose(0, 2, 1), s, atol=1e-9)
    np.testing.assert_allclose(_matrices(frames.turn), frames.axes, atol=1e-12)


def test_collapsed_faces_keep_their_edges():
    reference, posed, faces = _scene()
    posed[faces[0]] = [1.0, 2.0, 3.0]
    posed[faces[1, 1]] = posed[faces[1, 0]]
    posed[faces[2]] = posed[faces[2, 0]] + np.outer([0.0, 1.0, 2.5], [0.0, 0.3, 0.0])
    frames = face_frames(reference, faces)
    rotation, s = decompose(posed, faces, frames.axes, frames.edges)
    length, across, up = frames.edges.T
    local = np.zeros((len(faces), 2, 3))
    local[:, 0, 0], local[:, 0, 1] = s[:, 0] * length, s[:, 1] * length
    local[:, 1, 0], local[:, 1, 1] = s[:, 0] * across + s[:, 1] * up, s[:, 1] * across + s[:, 2] * up
    edges = np.einsum("fij,fjk,fek->fei", _matrices(rotation), frames.axes, local)
    expected = posed[faces[:, 1:]] - posed[faces[:, :1]]
    np.testing.assert_allclose(edges, expected, atol=1e-9)
    assert np.isfinite(rotation).all()


def test_reference_faces_without_area_are_marked():
    reference, _, faces = _scene()
    reference[faces[5]] = 0.5
    solid = face_frames(reference, faces).solid
    assert not solid[5] and solid.sum() >= len(faces) - 12
