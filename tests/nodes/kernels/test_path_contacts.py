import numpy as np

from reperform.nodes.kernels.path_contacts import path_contacts


def test_a_blend_rests_on_what_its_sources_rest_on() -> None:
    planted = [np.array([[1, 0], [1, 1], [0, 1]], bool), np.array([[0, 1], [1, 1]], bool)]
    take = np.array([[0, 0], [0, 1], [0, 1], [1, 1]])
    frame = np.array([[0, 0], [1, 0], [2, 1], [1, 1]])
    weight = np.array([[1, 0], [0.7, 0.3], [0.2, 0.8], [0.5, 0.5]])
    both = path_contacts(take, frame, weight, planted)
    np.testing.assert_array_equal(both, [[1, 0], [0, 1], [0, 1], [1, 1]])
    most = path_contacts(take, frame, weight, planted, 0.6)
    np.testing.assert_array_equal(most, [[1, 0], [1, 1], [1, 1], [1, 1]])
