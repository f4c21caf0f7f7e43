import numpy as np

from reperform.nodes.kernels.colour_gain import colour_gain


def test_known_gains_come_back_despite_outliers():
    random = np.random.default_rng(0)
    truth = random.uniform(40, 120, (400, 3))
    gains = np.array([[1, 1, 1], [1.3, 0.9, 1.1], [1, 1, 1], [0.8, 1.2, 0.7], [1, 1, 1]])
    colours = truth / gains[:, None]
    weights = random.uniform(0, 1, (5, 400)) * (random.uniform(size=(5, 400)) < 0.5)
    wrong = random.uniform(size=(5, 400)) < 0.1
    colours[wrong] = random.uniform(10, 240, (wrong.sum(), 3))
    np.testing.assert_allclose(colour_gain(colours, weights), gains, rtol=0.03)


def test_cameras_that_share_nothing_keep_their_colours():
    colours, weights = np.full((3, 4, 3), 100.0), np.zeros((3, 4))
    colours[1] = 50
    weights[:2, :2], weights[2, 2:] = 1, 1
    gains = colour_gain(colours, weights)
    np.testing.assert_allclose(gains[1] / gains[0], 2, rtol=1e-6)
    np.testing.assert_array_equal(gains[2], 1)


def test_dark_and_clipped_values_do_not_count():
    colours, weights = np.full((2, 6, 3), 100.0), np.ones((2, 6))
    colours[1, 0], colours[1, 1] = 255, 2
    np.testing.assert_allclose(colour_gain(colours, weights), 1)
