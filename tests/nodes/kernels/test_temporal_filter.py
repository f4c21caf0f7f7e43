import numpy as np

from reperform.nodes.kernels.temporal_filter import filter_diagonals


def test_by_hand_and_limits():
    matrix = np.array([[1.0, 2, 3], [4, 5, 6]])
    np.testing.assert_allclose(filter_diagonals(matrix, 0), matrix)
    np.testing.assert_allclose(filter_diagonals(matrix, 1), [[3, 4, 3], [4, 3, 4]])
    np.testing.assert_allclose(filter_diagonals(matrix, 9), filter_diagonals(matrix, 1))


def test_keeps_a_constant():
    np.testing.assert_allclose(filter_diagonals(np.full((5, 7), 0.3), 3), 0.3)
