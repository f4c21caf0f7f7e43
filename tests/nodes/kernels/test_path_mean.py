import numpy as np

from reperform.nodes.kernels.path_mean import path_mean


def test_sources_count_by_their_weights() -> None:
    values = [np.array([1.0, 2.0]), np.array([10.0, 20.0, 30.0])]
    take, frame = np.array([[0, 0], [0, 1], [1, 1]]), np.array([[1, 0], [0, 2], [1, 0]])
    weight = np.array([[1.0, 0.0], [0.25, 0.75], [0.5, 0.5]])
    np.testing.assert_allclose(path_mean(take, frame, weight, values), [2.0, 22.75, 15.0])
    doubled = [np.stack([v, -v], axis=1) for v in values]
    np.testing.assert_allclose(path_mean(take, frame, weight, doubled)[1], [22.75, -22.75])
