import numpy as np

from reperform.nodes.evaluate.play_life import play_life


def test_one_row_per_request_and_nothing_dies(playable):
    got = play_life(*playable, seconds=90.0, every=3.0, seed=4)
    assert got.value.shape == (30, 2)
    assert got.value[:, 1].sum() == 0
    assert 0 <= np.nanmin(got.value[:, 0]) <= np.nanmax(got.value[:, 0]) <= 1.2


def test_where_no_way_leads_back_it_dies(playable):
    """Without the edge from the jump to the walk, a character that has jumped stands for ever."""
    graph, spaces = playable
    stuck = graph._replace(target=np.array([1, 1], np.int32), source=np.array([0, 0], np.int32))
    stuck = stuck._replace(distance=np.concatenate([graph.distance[: len(graph.distance) // 2]] * 2))
    got = play_life(stuck, spaces, seconds=60.0, every=3.0, seed=4)
    assert got.value[:, 1].sum() > 5
