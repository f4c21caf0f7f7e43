import numpy as np

from reperform.nodes.evaluate.skating import skating
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.played import Played


def played(**fields):
    """Six frames at 20 Hz of nothing but feet and root."""
    mesh = MeshSequence(np.zeros((6, 3, 3), np.float32), np.array([[0, 1, 2]], np.int32), np.float32(20))
    rest = {name: np.zeros(0) for name in Played._fields}
    return Played(**{**rest, "mesh": mesh, **fields})


def test_speed_counts_only_while_a_foot_is_planted_twice_and_only_over_the_ground():
    soles = np.zeros((6, 2, 3))
    soles[:, 0] = np.outer(np.arange(6), [0.03, 0.5, 0.04])
    soles[:, 1, 0] = [0, 1, 1, 1, 1.002, 5]
    planted = np.ones((6, 2), bool)
    planted[[0, 1, 5], 1] = False
    got = skating(played(soles=soles, planted=planted))
    assert list(got.name) == ["foot 0", "foot 1"]
    np.testing.assert_allclose(got.value[1:, 0], 1.0, atol=1e-9)
    np.testing.assert_allclose(got.value[:, 1], [np.nan, np.nan, np.nan, 0.0, 0.04, np.nan], atol=1e-9)
    assert np.isnan(got.value[0, 0])
