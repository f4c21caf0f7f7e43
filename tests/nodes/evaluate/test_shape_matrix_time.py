import numpy as np

from reperform.nodes.evaluate.shape_matrix_time import shape_matrix_time
from reperform.nodes.products.shape_histograms import ShapeHistograms


def test_frames_are_repeated_until_there_are_enough():
    share = np.random.default_rng(0).random((3, 2, 3, 8)).astype(np.float32)
    take = ShapeHistograms(share, np.zeros((3, 3), np.float32), np.float32(1))
    found = shape_matrix_time({"a": take}, frames=20)
    assert found.value.shape == (1, 1)
    assert found.value[0, 0] > 0
