import numpy as np

from reperform.nodes.kernels.azimuth_correlation import azimuth_spectrum, correlate_azimuth


def test_peak_is_at_the_turn_and_one():
    share = np.random.default_rng(0).random((1, 2, 3, 16))
    weight = np.array([0.2, 0.9])
    a = azimuth_spectrum(np.roll(share, 5, axis=3), weight)
    b = azimuth_spectrum(share, weight)
    correlation = correlate_azimuth(a, b, 16)[0, 0]
    assert correlation.argmax() == 5
    np.testing.assert_allclose(correlation[5], 1)


def test_equals_direct_sum():
    rng = np.random.default_rng(1)
    x, y = rng.random((2, 2, 3, 10)), rng.random((3, 2, 3, 10))
    weight = np.array([0.5, 1.0])
    found = correlate_azimuth(azimuth_spectrum(x, weight), azimuth_spectrum(y, weight), 10)
    w = weight[:, None, None]
    p, q = x[1], y[2]
    direct = (w * p * np.roll(q, 7, axis=2)).sum() / np.sqrt((w * p**2).sum() * (w * q**2).sum())
    np.testing.assert_allclose(found[1, 2, 7], direct)
