import numpy as np
import pytest

from reperform.nodes.kernels import ground_plane, rotation
from reperform.nodes.kernels.deformation_metric import exact_distances, prepare, reference_pose, turns


def sheet(seed: int = 0, frames: int = 4) -> tuple[np.ndarray, np.ndarray]:
    """A crumpling sheet off centre, (frames, V, 3), and its faces."""
    from scipy.spatial import Delaunay

    rng = np.random.default_rng(seed)
    plane = rng.uniform(size=(60, 2)) * (0.7, 1.6)
    rest = np.column_stack([plane[:, 0] + 0.4, plane[:, 1], 0.2 * np.sin(3 * plane[:, 1])])
    waves = rng.normal(size=(frames, 1, 3)) * 2
    moved = rest + 0.3 * np.sin(rest[None] @ rng.normal(size=(3, 3)) + waves)
    return moved.astype(np.float32), Delaunay(plane).simplices.astype(np.int32)


def prepared(vertices: np.ndarray, faces: np.ndarray):
    reference = reference_pose(vertices[0], faces, np.ones(vertices.shape[1]))
    return reference, prepare(vertices, reference)


def by_definition(x: np.ndarray, y: np.ndarray, faces: np.ndarray, area: np.ndarray, weight: float) -> float:
    """The sum written out with matrices: gradients, polar decompositions, logarithms."""
    placement, _ = ground_plane.align(x, y)
    frames = []
    for v in (x.astype(np.float64), ground_plane.apply(y.astype(np.float64), placement)):
        e1, e2 = v[faces[:, 1]] - v[faces[:, 0]], v[faces[:, 2]] - v[faces[:, 0]]
        n = np.cross(e1, e2)
        frames.append(np.stack([e1, e2, n / np.sqrt(np.linalg.norm(n, axis=1, keepdims=True))], axis=2))
    r, s = rotation.polar(frames[1] @ np.linalg.inv(frames[0]))
    stretch = [np.linalg.norm(t - np.eye(3), axis=(1, 2)) for t in (s, np.linalg.inv(s))]
    return float(area @ (np.linalg.norm(rotation.log(r), axis=1) + weight * sum(stretch) / 2))


def test_agrees_with_the_definition():
    vertices, faces = sheet()
    reference, poses = prepared(vertices, faces)
    distance = exact_distances(poses, poses, reference.area, 0.3)
    for i, j in ((0, 1), (2, 1), (3, 2)):
        expected = by_definition(vertices[i], vertices[j], faces, reference.area, 0.3)
        assert distance[i, j] == pytest.approx(expected, rel=2e-6)


def test_same_pose_is_at_zero_and_both_ways_are_one():
    vertices, faces = sheet(1)
    reference, poses = prepared(vertices, faces)
    distance = exact_distances(poses, poses, reference.area, 0.3)
    np.testing.assert_allclose(distance.diagonal(), 0, atol=1e-6)
    np.testing.assert_allclose(distance, distance.T, rtol=1e-5)


def test_a_rigid_turn_counts_its_angle_but_for_what_is_about_the_vertical():
    vertices, faces = sheet(2, 1)
    reference, poses = prepared(vertices, faces)
    for axis in ((1.3, 0, 0), (0, 0.9, 0), (0.4, 2.0, -0.8)):
        turn = rotation.exp(np.array(axis))
        other = prepare(vertices @ turn.T.astype(np.float32), reference)
        left = rotation.exp(np.array([0, turns(poses.ground, other.ground)[0, 0], 0])) @ turn
        distance = exact_distances(poses, other, reference.area, 0.3)[0, 0]
        assert distance == pytest.approx(np.linalg.norm(rotation.log(left)), abs=2e-5)
        assert (distance < 1e-4) == (axis[0] == 0)


def test_growing_by_a_factor_counts_the_same_stretch_in_all_directions():
    vertices, faces = sheet(3, 1)
    reference, poses = prepared(vertices, faces)
    distance = exact_distances(poses, prepare(1.25 * vertices, reference), reference.area, 1.0)[0, 0]
    assert distance == pytest.approx(np.sqrt(3) * (0.25 + 0.2) / 2, rel=1e-4)


def test_the_reference_does_not_matter():
    vertices, faces = sheet(4)
    first, poses = prepared(vertices, faces)
    other = prepare(vertices, reference_pose(vertices[2], faces, np.ones(vertices.shape[1])))
    np.testing.assert_allclose(
        exact_distances(poses, poses, first.area, 0.3),
        exact_distances(other, other, first.area, 0.3),
        rtol=1e-5, atol=1e-6,
    )  # fmt: skip


def test_more_faces_than_a_block():
    vertices, faces = sheet(5, 2)
    reference, poses = prepared(vertices, faces)
    many, copies = prepared(vertices, np.tile(faces, (30, 1)))
    assert len(many.area) > 2048
    np.testing.assert_allclose(
        exact_distances(copies, copies, many.area, 0.3),
        exact_distances(poses, poses, reference.area, 0.3),
        rtol=1e-5, atol=1e-6,
    )  # fmt: skip


def test_what_cannot_be_a_reference_is_refused():
    vertices, faces = sheet(6, 1)
    ones = np.ones(vertices.shape[1])
    with pytest.raises(ValueError, match="faces must name vertices"):
        reference_pose(vertices[0], faces + 1000, ones)
    with pytest.raises(ValueError, match="has an area"):
        reference_pose(np.zeros_like(vertices[0]), faces, ones)
    with pytest.raises(ValueError, match="positive sum"):
        reference_pose(vertices[0], faces, 0 * ones)
