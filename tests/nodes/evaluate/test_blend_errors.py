import numpy as np

from reperform.nodes.evaluate.blend_errors import METHODS, blend_errors


def test_a_turned_body_errs_by_the_sagitta(turned_pairs, slab):
    """Linear blending cuts the arc: at w = 0.5 a vertex at radius r is r (1 - cos(angle / 2)) off."""
    errors = blend_errors(turned_pairs, steps=8)
    axis = np.array([0.2, 1.0, -0.4]) / np.linalg.norm([0.2, 1.0, -0.4])
    radius = np.linalg.norm(np.cross(slab[0] - slab[0].mean(0), axis), axis=1).max()
    for k, angle in enumerate((1.0, 2.0)):
        parts = (angle / 2, angle / 4, angle / 8)
        for m, part in enumerate(parts):
            expected = radius * (1 - np.cos(part))
            np.testing.assert_allclose(errors.largest[k, m].max(), expected, rtol=0.01)
    assert (errors.average <= errors.rms + 1e-12).all() and (errors.rms <= errors.largest + 1e-12).all()


def test_a_rigid_body_keeps_volume_edges_and_its_true_middle(turned_pairs):
    errors = blend_errors(turned_pairs, steps=8)
    exact = METHODS.index("non-linear")
    assert errors.volume[:, exact].max() < 1e-5 and errors.strain[:, exact].max() < 1e-4
    assert errors.truth[:, exact].max() < 1e-4 and errors.end.max() < 1e-6
    assert (errors.volume[:, 0].max(axis=1) > 0.05).all()
    assert (errors.truth[:, 0, 0] > errors.truth[:, 1, 0]).all()


def test_middles_that_are_not_known_are_not_measured(turned_pairs):
    errors = blend_errors(turned_pairs._replace(middle=np.full_like(turned_pairs.middle, np.nan)), steps=2)
    assert np.isnan(errors.truth).all() and np.isfinite(errors.largest).all()
    assert errors.vertices == turned_pairs.first.shape[1]
