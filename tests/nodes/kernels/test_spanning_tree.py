import numpy as np

from reperform.nodes.kernels.spanning_tree import minimum_spanning_tree, path_cost_sums, rehang


def test_by_hand():
    # a path 0 - 2 - 1 - 3 with edges 1, 2, 4
    matrix = np.array([[0.0, 9, 1, 9], [9, 0, 2, 4], [1, 2, 0, 9], [9, 4, 9, 0]])
    parent, order = minimum_spanning_tree(matrix)
    np.testing.assert_array_equal(parent, [0, 2, 0, 1])
    np.testing.assert_array_equal(order, [0, 2, 1, 3])
    sums = path_cost_sums(parent, order, matrix[np.arange(4), parent])
    np.testing.assert_array_equal(sums, [1 + 3 + 7, 2 + 3 + 4, 1 + 2 + 6, 4 + 6 + 7])
    turned, order = rehang(parent, 1)
    np.testing.assert_array_equal(turned, [2, 1, 1, 1])
    np.testing.assert_array_equal(order, [1, 2, 3, 0])


def test_a_single_node():
    parent, order = minimum_spanning_tree(np.zeros((1, 1)))
    assert parent.tolist() == order.tolist() == [0]
    assert rehang(parent, 0)[1].tolist() == [0]
