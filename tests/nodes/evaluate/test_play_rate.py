import numpy as np

from reperform.nodes.evaluate.play_rate import play_rate


def test_every_frame_is_timed_and_a_crowd_takes_longer(playable):
    one = play_rate(*playable, seconds=2.0, every=0.7, repeats=2)
    many = play_rate(*playable, seconds=2.0, every=0.7, repeats=2, characters=12)
    assert list(one.name) == ["frame", "rate"]
    assert list(one.unit) == ["ms", "Hz"]
    assert one.value.shape == (100, 2)
    np.testing.assert_allclose(one.value[:, 0] * one.value[:, 1], 1000)
    assert np.median(many.value[:, 0]) > 4 * np.median(one.value[:, 0])
