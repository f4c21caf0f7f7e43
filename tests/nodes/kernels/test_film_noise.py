import numpy as np
import pytest

from reperform.nodes.kernels.film_noise import expose

ONE = np.ones(3, np.float32)


def test_without_noise_it_rounds():
    light = np.array([[[0.4, 0.6, 300.0], [-4.0, 128.5, 254.4]]], np.float32)
    assert expose(light, ONE, 0.0, 1).tolist() == [[[0, 1, 255], [0, 129, 254]]]


@pytest.mark.parametrize("level", [40.0, 128.0, 220.0])
def test_mean_and_deviation(level):
    light = np.full((300, 400, 3), level, np.float32)
    picture = expose(light, ONE, 4.0, 7).astype(float)
    expected = np.sqrt(16 * (0.2 + 0.8 * level / 255) + 1 / 12)
    assert picture.mean() == pytest.approx(level, abs=0.05)
    assert picture.std() == pytest.approx(expected, rel=0.02)
    centred = picture - picture.mean()
    assert abs((centred[:, 1:] * centred[:, :-1]).mean()) < 0.02 * expected**2
    assert abs((centred[..., 0] * centred[..., 1]).mean()) < 0.02 * expected**2
    # kurtosis of a sum of four uniforms is 3 - 1.2 / 4
    assert (centred**4).mean() / (centred**2).mean() ** 2 == pytest.approx(2.7, abs=0.08)


def test_the_seed_decides():
    light = np.full((20, 30, 3), 90, np.float32)
    assert np.array_equal(expose(light, ONE, 3.0, 5), expose(light, ONE, 3.0, 5))
    assert not np.array_equal(expose(light, ONE, 3.0, 5), expose(light, ONE, 3.0, 6))


def test_gains_tint():
    light = np.full((4, 4, 3), 100, np.float32)
    tinted = expose(light, np.array([1.1, 1.0, 0.5], np.float32), 0.0, 0)
    assert tinted[0, 0].tolist() == [110, 100, 50]
