import numpy as np

from reperform.nodes.evaluate.threshold_curves import threshold_curves


def test_error_and_memory_go_opposite_ways(turning_takes):
    curves = threshold_curves(turning_takes, epsilons=(0.0, 0.004, 0.02, 0.5), levels=2)
    assert curves.references.tolist() == [1, 3]
    assert (np.diff(curves.stored, axis=1) <= 0).all() and (np.diff(curves.error, axis=1) >= -1e-9).all()
    assert curves.error[1, 0] < curves.error[0, 0] / 3
    np.testing.assert_allclose(curves.dense[1], 3 * curves.dense[0])
    np.testing.assert_allclose(curves.corrected[:, 0], 1.0)
    assert (curves.corrected[:, -1] == 0).all()
