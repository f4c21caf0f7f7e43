import numpy as np
import pytest
from scipy.stats import spearmanr

from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.similarity.deformation_gradient import alignment_weights, deformation_gradient
from reperform.nodes.studio.perform import perform


@pytest.fixture(scope="module")
def takes() -> tuple[MeshSequence, MeshSequence]:
    return perform(motion="walk", seconds=0.5).mesh, perform(motion="dance", seconds=0.4, heading=1.0).mesh


def test_placing_a_take_elsewhere_changes_nothing(takes):
    a, b = takes
    moved = b._replace(vertices=apply(np.asarray(b.vertices), Placement(2.2, np.array([3.0, -1.0]))))
    for clusters in (0, 200):
        before, after = (deformation_gradient((a, x), clusters=clusters).distance for x in (b, moved))
        np.testing.assert_allclose(before, after, atol=2e-5)
        assert before.shape == (len(a.vertices), len(b.vertices))
        assert before.dtype == np.float32


def test_clusters_keep_the_order(takes):
    exact, quick = (deformation_gradient(takes, clusters=count).distance for count in (0, 400))
    assert spearmanr(exact.ravel(), quick.ravel()).statistic > 0.99
    assert (quick <= exact + 1e-3).all()


def test_swapping_the_takes_transposes(takes):
    a, b = takes
    np.testing.assert_allclose(
        deformation_gradient((a, b), clusters=0).distance,
        deformation_gradient((b, a), clusters=0).distance.T,
        rtol=1e-5,
    )


def test_the_trunk_leads_the_alignment(takes):
    mesh = takes[1]
    vertices, faces = np.asarray(mesh.vertices[0]), np.asarray(mesh.faces)
    near, everywhere = (alignment_weights(vertices, faces, focus) for focus in (0.2, 0.0))
    middle = vertices[:, [0, 2]] - everywhere @ vertices[:, [0, 2]] / everywhere.sum()
    away = np.linalg.norm(middle, axis=1)
    assert near @ away / near.sum() < 0.95 * (everywhere @ away / everywhere.sum())


def test_other_topologies_and_flat_takes_are_refused(takes):
    a, b = takes
    with pytest.raises(ValueError, match="share one topology"):
        deformation_gradient((a, b._replace(faces=np.asarray(b.faces)[1:])))
    with pytest.raises(ValueError, match="has an area"):
        deformation_gradient((a._replace(vertices=np.zeros_like(a.vertices)), b))
