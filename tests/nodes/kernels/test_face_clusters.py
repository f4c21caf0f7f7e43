import numpy as np
import pytest

from reperform.nodes.kernels.deformation_metric import exact_distances, prepare, reference_pose
from reperform.nodes.kernels.face_clusters import (
    bisect_faces,
    cluster_areas,
    cluster_distances,
    cluster_poses,
)
from reperform.nodes.kernels.mesh_geometry import face_areas
from reperform.nodes.studio.perform import perform


@pytest.fixture(scope="module")
def dance():
    mesh = perform(motion="dance", seconds=0.4).mesh
    return np.asarray(mesh.vertices), np.asarray(mesh.faces)


def test_clusters_are_all_used_and_alike_in_area(dance):
    vertices, faces = dance
    label = bisect_faces(vertices[0], faces, 37)
    area = np.bincount(label, weights=face_areas(vertices[0].astype(np.float64), faces))
    assert len(area) == 37
    assert area.max() < 3 * area.min()


def test_the_back_and_the_front_of_a_leaf_are_apart():
    plane = np.array([[0, 0, 0], [2, 0, 0], [0, 3, 0], [0, 0, 0.01], [2, 0, 0.01], [0, 3, 0.01]], np.float32)
    faces = np.array([[0, 2, 1], [3, 4, 5]], np.int32)
    assert len(np.unique(bisect_faces(plane, faces, 2))) == 2
    assert len(np.unique(bisect_faces(plane, faces, 9))) == 2


def test_off_by_no_more_than_the_bound(dance):
    vertices, faces = dance
    reference = reference_pose(vertices[0], faces, np.ones(vertices.shape[1]))
    poses = prepare(vertices, reference)
    exact = exact_distances(poses, poses, reference.area, 0.01)
    errors = []
    for count in (20, 400):
        label = bisect_faces(vertices[0], faces, count)
        means = cluster_poses(poses, reference, label, 0.01)
        found = cluster_distances(means, means, cluster_areas(reference, label))
        error = np.abs(found - exact)
        assert (error <= means.bound[:, None] + means.bound[None] + 1e-6).all()
        errors.append(error.max())
    assert errors[1] < 0.5 * errors[0]


def test_one_cluster_per_face_is_the_metric_without_stretch(dance):
    vertices, faces = dance
    faces = faces[:300]
    reference = reference_pose(vertices[0], faces, np.ones(vertices.shape[1]))
    # bending without stretching leaves no turn within the planes: rigid turns do
    tilt = np.array([[1, 0, 0], [0, 0.8, -0.6], [0, 0.6, 0.8]])
    poses, other = (prepare(v, reference) for v in (vertices[:1], vertices[:1] @ tilt.T))
    label = np.arange(300, dtype=np.int32)
    a, b = (cluster_poses(p, reference, label, 0.0) for p in (poses, other))
    np.testing.assert_allclose(
        cluster_distances(a, b, cluster_areas(reference, label)),
        exact_distances(poses, other, reference.area, 0.0),
        rtol=1e-4,
    )
