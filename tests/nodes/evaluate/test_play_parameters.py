import numpy as np

from reperform.nodes.evaluate.play_parameters import play_parameters


def test_what_is_played_is_what_was_asked(playable):
    got = play_parameters(*playable, count=4, seed=1)
    assert list(got.name) == ["speed", "turning", "height", "length", "reach"]
    walked, jumped = got.value[:4], got.value[4:]
    assert np.isnan(walked[:, 2:]).all()
    assert np.isnan(jumped[:, [0, 1, 3, 4]]).all()
    assert np.nanmax(got.value) < 0.05


def test_a_map_that_lies_is_found_out(playable):
    graph, spaces = playable
    jump = spaces["jump"]
    wrong = {**spaces, "jump": jump._replace(inverse=0.5 + 0 * jump.inverse)}
    got = play_parameters(graph, wrong, count=4, seed=1)
    assert np.nanmax(got.value[:, 2]) > 0.1
